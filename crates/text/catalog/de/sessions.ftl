sessions-title = Sitzungen
sessions-trainee = Trainee
sessions-show = Anzeigen
sessions-show-all = Alle anzeigen
sessions-import = Flug importieren
sessions-my-progress = Mein Fortschritt und Plan
sessions-none = Noch keine Sitzungen. Flüge erscheinen hier, sobald sie beendet sind.
sessions-count =
    { $count ->
        [one] { $count } Sitzung, neueste zuerst
       *[other] { $count } Sitzungen, neueste zuerst
    }
sessions-started = Beginn
sessions-overall = Gesamt
sessions-overall-of = { $score } von { $most }
sessions-certified = Zertifiziert
sessions-scenario = Szenario
sessions-purpose = Zweck
sessions-end = Ende

sessions-page = Sitzung: { $scenario }
sessions-flight-time = Flugzeit { $time }, { $end }
sessions-better = Besser machen
sessions-marks = Markierungen
sessions-video = Video
sessions-pictures = Bilder
sessions-scores = Wertung
sessions-certification = Zertifizierung
sessions-tasks = Aufgaben
sessions-defects = Schäden
sessions-compare-with = Vergleichen mit
sessions-show-moment = { $time } zeigen
sessions-next-flight = Nächster Flug, nur auf Grundlage dieser Sitzung: { $job }.
sessions-plan = Trainingsplan, auf Grundlage aller Sitzungen
sessions-no-marks = Noch keine Markierungen. Markierungen erscheinen auf der Zeitleiste des Berichts; sie ändern die Wertung nicht.
sessions-remove-mark = Entfernen
sessions-remove-mark-at = Markierung bei { $time } entfernen
sessions-mark-time = Zeit auf dem Schieberegler des Berichts (Minuten:Sekunden)
sessions-mark-text = Text
sessions-your-name = Ihr Name
sessions-add-mark = Markierung hinzufügen
sessions-mark-time-invalid = time = { $value }: ungültige Zeit (zulässig: 0:00 bis { $end }, Minuten und Sekunden)
sessions-too-many-marks = Es gibt bereits { $most } Markierungen: Entfernen Sie zuerst eine.
sessions-picture = Bild { $number }
sessions-standing-best = Dies ist die persönliche Bestleistung bei diesem Auftrag.
sessions-standing-other = Persönliche Bestleistung bei diesem Auftrag: { $best } von { $most }.
sessions-standing-same = Änderung seit dem letzten Mal: keine.
sessions-standing-up =
    Änderung seit dem letzten Mal: { $points ->
        [one] { $points } Punkt
       *[other] { $points } Punkte
    } mehr.
sessions-standing-down =
    Änderung seit dem letzten Mal: { $points ->
        [one] { $points } Punkt
       *[other] { $points } Punkte
    } weniger.
sessions-standing-forms = Verglichen werden die Sitzungen mit den gleich schwierigen Varianten { $forms }.
sessions-report = Bericht öffnen
sessions-questions-answer = Fragebogen beantworten
sessions-questions-continue = Fragebogen fortsetzen ({ $answered } von { $all })
sessions-questions-view = Fragebogen ansehen (alle { $all } beantwortet)
sessions-frames = Datensätze (CSV)
sessions-telemetry = Telemetrie (tlog)
sessions-no-folder = Der Sitzungsordner ist nicht auf diesem Rechner; deshalb sind Bericht, Fragebogen und Downloads nicht verfügbar.
sessions-partial = Die folgenden Wertungen gelten nur für den geflogenen Teil.
sessions-radar-caption = Die vier Wertungen, 0 in der Mitte, 100 am Rand
sessions-radar = Netzdiagramm der vier Wertungen
sessions-of-most = von { $most }
sessions-not-available = entfällt
sessions-requirements = Anforderungen
sessions-requirement = Anforderung
sessions-reached = Erreicht
sessions-needed = Erforderlich
sessions-met = Erfüllt
sessions-yes = ja
sessions-no = nein
sessions-not-attempted = nicht begonnen
sessions-on-path-by-task = Anteil auf der Bahn je Aufgabe
sessions-task-results = Ergebnisse der Aufgaben
sessions-task = Aufgabe
sessions-path-flown = Geflogene Bahn
sessions-on-path = Anteil auf der Bahn (%)
sessions-speeding = Zeit über dem Tempolimit (s)
sessions-crashes = Kollisionen
sessions-defects-found = Gefundene Schäden
sessions-found-of = { $found } von { $placed }
sessions-crashes-outside =
    { $count ->
        [one] { $count } Kollision außerhalb der Aufgaben.
       *[other] { $count } Kollisionen außerhalb der Aufgaben.
    }
sessions-unknown = unbekannt
sessions-defects-caption =
    { $found } von { $placed } gefunden; { $hits } von { $pictures ->
        [one] { $pictures } Bild
       *[other] { $pictures } Bildern
    } { $hits ->
        [one] zeigte
       *[other] zeigten
    } einen neuen Schaden
sessions-defect = Schaden
sessions-found = Gefunden
sessions-why-not = Warum das beste Bild nicht zählte
sessions-no-picture = kein Bild in der Nähe aufgenommen
sessions-no-others = Für diesen Trainee gibt es noch keine anderen Sitzungen.
sessions-other = Andere Sitzung
sessions-incomplete = unvollständig
sessions-compare = Vergleichen
sessions-compare-missing = { $field }: fehlt (erforderlich: eine Sitzungs-ID)
