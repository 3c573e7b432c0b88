## All pages

window-back = Zurück (Esc)
window-help = Auf/ab: wählen, links/rechts: ändern, Enter: bestätigen; oder klicken.
window-help-dialog = Auf/ab: wählen, Enter: bestätigen; oder klicken.
window-language = Language / Sprache / Idioma
window-on = ein
window-off = aus

## Start page

window-start-title = Spandrel: eine Brücke mit der Drohne prüfen
window-start-trainee = Trainee
window-start-job = Auftrag
window-start-aircraft = Fluggerät
window-start-purpose = Zweck
window-start-check-controller = Weiter: Steuerung prüfen
window-start-watch-expert = Experten bei diesem Auftrag zusehen
window-start-tutorial = Einführung lesen
window-start-school = Schadensschule: Schäden auf Bildern erkennen
window-start-settings = Einstellungen: Tasten, Einheiten, Schrift, Ton
window-start-quit = Beenden
window-start-recommended = Empfohlen: { $job }
window-start-assigned = Zugewiesen, fällig am { $date }: { $job }
window-start-enter-name = Geben Sie ein Pseudonym ein, keinen echten Namen.
window-start-no-sessions = Noch keine Sitzungen. Um das Pseudonym zu ändern, tippen Sie ein anderes ein.
window-start-from-last-session = Diese Empfehlung folgt nur aus Ihrer letzten Sitzung. Mit eingeschalteten Webseiten berücksichtigt sie alle.
window-start-sessions =
    { $count ->
        [one] Bisher eine Sitzung.
       *[other] Bisher { $count } Sitzungen.
    }
window-start-tutorial-first = Ihr erster Übungsflug beginnt mit der Einführung.
window-start-last-flight = Letzter Flug: { $words }
window-start-about-practice = Sie können pausieren und neu starten; die Karte zeigt die Bahnen.
window-start-about-assessment = Ein Versuch: ohne Pause, Neustart und Karte.
window-start-web = Sitzungen im Browser ansehen
window-start-name-characters = Verwenden Sie Buchstaben (ohne Umlaute), Ziffern, „-“ und „_“; beginnen Sie mit einem Buchstaben oder einer Ziffer.
window-start-name-length = Höchstens { $count } Zeichen.
window-start-name-first = Geben Sie zuerst ein Pseudonym ein.

## Waiting

window-waiting-simulator = Simulator startet ...
window-waiting-scoring = Flug wird bewertet ...
window-waiting-pictures = Bilder werden vorbereitet ...
window-waiting-briefing = Briefing wird vorbereitet ...

## Briefing

window-briefing-title = Einweisung: { $job }
window-briefing-acknowledge = Gelesen und Einsatzort kontrolliert: fliegen
window-briefing-print = Einweisung drucken
window-briefing-site-check = Kontrolle des Einsatzorts
window-briefing-tasks = Aufgaben, in dieser Reihenfolge
window-briefing-conditions = Bedingungen
window-briefing-hazards = Gefahren
window-briefing-counts = Was zählt
window-briefing-notes = Von Ihrem Ausbilder
window-briefing-map = Karte
window-briefing-side = Brücke „{ $bridge }“ von der Seite
window-briefing-from-south = Von Süden

## Controller

window-controls-title = Steuerung prüfen
window-controls-none = Kein Controller gefunden. Verwenden Sie die Tastatur.
window-controls-lost = { $name } nicht verbunden: Tastatur aktiv
window-controls-calibrated = { $name }, kalibriert
window-controls-not-calibrated = { $name }, nicht kalibriert: Tastatur aktiv
window-controls-fly = Flug starten
window-controls-calibrate = Kalibrieren
window-controls-calibrate-again = Neu kalibrieren
window-controls-search = Controller suchen
window-controls-mode = Knüppelmodus
window-controls-dead-band = Totzone
window-controls-expo = Expo
window-controls-continue = Weiter (Enter)
window-controls-cancel = Abbrechen (Esc)
window-controls-press-keys = Drücken Sie die Flugtasten; die Punkte sollten folgen. Weiter mit Tab und Enter oder der Maus.
window-controls-move-sticks = Bewegen Sie die Knüppel; die Punkte sollten folgen, zur Mitte zurückkehren und alle Ränder erreichen.
window-controls-left-stick = linker Knüppel
window-controls-right-stick = rechter Knüppel
window-controls-vertical = vertikal: { $words }
window-controls-horizontal = horizontal: { $words }
window-controls-pitch = vor, zurück
window-controls-throttle = hoch, runter
window-controls-roll = links, rechts
window-controls-yaw = drehen
window-controls-axis = Achse { $number }
window-controls-no-axis = Noch keine Achse bewegt.
window-controls-note-none = Kein Gamepad und keine Fernsteuerung verbunden.
window-controls-note-no-match = Kein Gerät passt zu '{ $wanted }' (verbunden: { $connected }).
window-controls-note-ambiguous = Mehrere Geräte passen ({ $connected }). Lassen Sie nur eines verbunden.
window-controls-note-no-access = Controller sind auf diesem Computer nicht nutzbar: { $error }
window-controls-note-unsupported = Dieses Programm wurde ohne Unterstützung für Controller gebaut.
window-controls-note-invalid-profile = Das Profil des Controllers ist ungültig: { $error }
window-controls-note-profile = Profil: { $file }.
window-controls-note-not-calibrated = „{ $name }“ ist noch nicht kalibriert.
window-controls-note-saved = Gespeichert in { $file }.
window-controls-note-not-saved = Nicht gespeichert: { $error }.
window-controls-note-disabled = Controller abgeschaltet: { $error }.
window-controls-note-lost = „{ $name }“ ist nicht verbunden.
window-controls-message-connected = Controller verbunden. { $note } Fliegen Sie damit.
window-controls-message-connected-uncalibrated = Controller verbunden. { $note } Verwenden Sie die Tastatur, bis er kalibriert ist.
window-controls-message-keyboard = { $note } Verwenden Sie die Tastatur.
window-controls-message-disconnected = „{ $name }“ getrennt: Knüppel zentriert, dann keine Eingabe mehr. Drücken Sie eine Taste, um mit der Tastatur zu fliegen.
window-controls-message-reconnected = „{ $name }“ wieder verbunden.
window-controls-the-controller = der Controller

## Pause

window-paused-title = Pause
window-paused-text = Die Uhr ist angehalten.
window-paused-resume = Fortsetzen (Esc)
window-paused-restart = Neu starten
window-paused-restart-again = Jetzt neu starten? Noch einmal drücken
window-paused-settings = Einstellungen und Tasten
window-paused-end = Sitzung beenden
window-paused-end-again = Sitzung jetzt beenden? Noch einmal drücken
window-paused-confirm-title = Bewertungsflug beenden?
window-paused-confirm-text = Die Uhr läuft. Nicht geflogene Aufgaben gelten als nicht begonnen.
window-paused-keep-flying = Weiterfliegen (Esc)
window-paused-score = Beenden und Flug bewerten
window-paused-pause-button = Pause ({ $pause })
window-paused-end-button = Beenden ({ $pause })
window-paused-no-restart = Ein Bewertungsflug kann nicht neu gestartet werden.

## Result

window-result-lesson-done = Lektion abgeschlossen
window-result-lesson-steps =
    { $done } von { $steps ->
        [one] { $steps } Schritt
       *[other] { $steps } Schritten
    } der Lektion erledigt
window-result-title = Flug beendet
window-result-part = { $why }. Die Wertung gilt für den geflogenen Teil.
window-result-advice = Das nächste Mal besser
window-result-overall = gesamt  { $sum } von { $most }
window-result-no-scores = keine Wertung
window-result-not-applicable = entfällt
window-result-more-unmet = { $count } weitere: siehe Bericht
window-result-report = Bericht
window-result-not-available = nicht vorhanden
window-result-moment = Im Bericht zeigen
window-result-moment-number = { $time } ({ $number } von { $count })
window-result-open-report = Bericht öffnen
window-result-open-questionnaire = Fragebogen öffnen
window-result-fly-yourself = Selbst fliegen: { $job }
window-result-fly-next = Als Nächstes: { $job }
window-result-watch-again = Noch einmal ansehen
window-result-fly-again = Noch einmal fliegen
window-result-choose = Anderen Auftrag wählen
window-result-after = { $reason } nach { $minutes } min { $seconds } s Flug
window-result-not-scored = Die Sitzung wurde nicht bewertet. Die Aufzeichnung liegt in { $folder }
window-result-not-scored-because = Die Sitzung wurde nicht bewertet: { $error }

## Defect school

window-school-another = Noch eine Runde
window-school-next = Nächstes Bild
window-school-start-page = Zur Startseite
window-school-stop = Aufhören (Esc)
window-school-title = Schadensschule: Bild { $number } von { $count }
window-school-again = Das war vorhin falsch. Noch einmal:
window-school-question = Was ist in der Mitte?
window-school-complete = Schadensschule: Runde beendet
window-school-right = { $right } von { $asked } im ersten Versuch richtig.
window-school-missed = Falsch: { $kinds }. Sie sehen sie bald wieder.
window-school-no-more = In dieser Runde gab es keine weiteren Bilder.
window-school-mastered =
    { $count ->
        [one] { $count } Bildart beherrschen Sie: mindestens viermal hintereinander richtig.
       *[other] { $count } Bildarten beherrschen Sie: mindestens viermal hintereinander richtig.
    }
window-school-failed = Die Schadensschule ist ausgefallen. Bitte informieren Sie Ihren Ausbilder.
window-school-failed-because = Die Schadensschule ist ausgefallen: { $error }

## Settings

window-settings-title = Einstellungen
window-settings-language = Sprache
window-settings-language-about = Sprache des Fensters und der Ansagen. Auch Berichte verwenden sie. Protokolle, Datendateien und die Meldungen des Fluggeräts bleiben englisch.
window-settings-keys = Tasten
window-settings-keys-about = Tastenbelegung ansehen und ändern.
window-settings-units = Einheiten
window-settings-units-about = Einheiten auf dem Bildschirm. Berichte und Dateien sind immer metrisch.
window-settings-metric = metrisch (m, m/s)
window-settings-us = US (ft, mph)
window-settings-text-size = Schriftgröße
window-settings-text-size-about = Größe aller Texte und Zahlen. Bei großer Schrift lässt die Fluganzeige weniger wichtige Werte weg, und lange Seiten werden mit Bild auf, Bild ab oder dem Mausrad gescrollt.
window-settings-picture = Bild
window-settings-picture-about = Detailgrad der Bilder. Auto ist hoch mit Grafikkarte und niedrig ohne. Eine Änderung gilt ab dem nächsten Flug.
window-settings-auto = auto
window-settings-low = niedrig
window-settings-medium = mittel
window-settings-high = hoch
window-settings-ultra = ultra
window-settings-sound = Ton
window-settings-sound-about = Gesamten Ton ein- oder ausschalten.
window-settings-volume = Lautstärke
window-settings-volume-about = Lautstärke der Propeller und der Warntöne.
window-settings-propellers = Propeller
window-settings-propellers-about = Propellergeräusch. Es wird leiser, wenn die Drohne wegfliegt.
window-settings-warnings = Warnungen
window-settings-warnings-about = Ein Ton für jede Warnung. Jede Warnung steht immer auch auf dem Bildschirm.
window-settings-speech = Sprachausgabe
window-settings-speech-about = Warnungen werden gesprochen, wenn espeak-ng oder spd-say installiert ist.
window-settings-restore = Alle Standardwerte wiederherstellen
window-settings-restore-about = Setzt alle Einstellungen und Tasten zurück.
window-settings-back-about = Alle Änderungen sind gespeichert.
window-settings-key-unusable = Diese Taste geht nicht. Drücken Sie eine andere, oder Esc zum Abbrechen.
window-settings-nothing-changed = Nichts geändert.
window-settings-keys-fixed = Die Tasten stammen aus { $file }. Ändern Sie sie dort.
window-settings-press-key = Taste drücken
window-settings-restore-keys = Standardtasten wiederherstellen
window-settings-keys-awaiting = Drücken Sie die neue Taste. Esc bricht ab.
window-settings-keys-help = Enter oder Klick auf eine Zeile, dann die neue Taste drücken. F11 schaltet immer auf Vollbild.
window-settings-key-set = { $key }: { $function }.
window-settings-key-exchanged = { $key }: { $function }. Die Taste war belegt: „{ $other }“ hat jetzt { $other_key }.
window-settings-key-refused = „{ $key }“ geht nicht (erlaubt: { $allowed }).
window-settings-keys-restored = Alle Tasten haben ihre Standardbelegung.
window-settings-all-restored = Alle Einstellungen haben ihre Standardwerte.
window-settings-file-invalid = Es gelten die Standardwerte, weil die Einstellungsdatei ungültig ist: { $error }
window-settings-not-saved-invalid = Nicht gespeichert, weil die Einstellungsdatei ungültig ist: { $error }. Korrigieren Sie sie, oder stellen Sie alle Standardwerte wieder her.
window-settings-not-saved = Nicht gespeichert: { $error }.

## Messages over the flight

window-flight-ghost-assessment = Kein Geist im Bewertungsflug.
window-flight-map-assessment = Keine Karte im Bewertungsflug.
window-flight-map-off = Keine Karte: Dieses Fenster wurde mit --no-map gestartet.
window-flight-ghost-expert = Kein Geist, während Sie dem Experten zusehen.
window-flight-ghost-not-ready = Der Geist ist noch nicht bereit: Ein Experte fliegt diesen Auftrag im Hintergrund. Versuchen Sie es in einer Minute wieder.
window-flight-ghost-changed = Kein Geist Ihrer eigenen Flüge: Dieser Auftrag hat sich seitdem geändert. Ein Experte fliegt ihn im Hintergrund. Versuchen Sie es in einer Minute wieder.
window-flight-ghost-no-session = Kein Geist ohne Sitzung: Wählen Sie einen Flug auf der Startseite des Simulators.
window-flight-ghost = Geist: { $words }.
window-flight-ghost-hidden = Geist ausgeblendet.
window-flight-ghost-best = Ihr bester Flug, { $overall } von { $most }
window-flight-ghost-of-expert = der Flug des Experten
window-flight-ghost-of-expert-changed = der Flug des Experten, weil sich dieser Auftrag seit Ihren eigenen Flügen geändert hat
window-flight-sound-on = Ton ein.
window-flight-sound-off = Ton aus.
window-flight-no-browser = Der Browser lässt sich nicht öffnen ({ $error }). Geben Sie die Adresse oben in einem Browser ein.
window-flight-frozen = Eingefroren.
window-flight-frozen-keys = Eingefroren. { $freeze }: weiter    { $rewind }: 10 s zurückspulen
window-flight-walk = Prüfer: unterwegs zu Standort { $place }, noch { $seconds } s
window-flight-no-places = In diesem Auftrag hat der Prüfer nur einen Standort.
window-flight-walk-not-here = Nur ein Fenster, das die Drohne fliegt, kann den Prüfer schicken.
window-flight-loading = { $what } laden ... { $pct }%
window-flight-loading-site = Einsatzort und Schäden
window-flight-loading-bridges = Brücken
window-flight-loading-ground = Boden
window-flight-loading-plants = Pflanzen
window-flight-loading-water = Wasser
window-flight-loading-graphics = Grafik
window-loading-job = Auftrag wird geladen ... { $pct }%
window-loading-monitor = Einsatzort und Monitor werden geladen ... { $pct }%
window-loading-simulator = Simulator wird gestartet ... { $pct }%
window-loading-scores = Telemetrie wird ausgewertet ... { $pct }%
window-loading-record = Sitzungsdaten werden gespeichert ... { $pct }%
window-loading-next-flights = Nächste Flüge werden ausgewählt ... { $pct }%
window-flight-waiting-seed = Mit dem Fluggerät verbunden. Warten auf den Startwert der Sitzung ...
window-flight-waiting-vehicle = Warten auf das Fluggerät unter { $address } ...
window-flight-keys-view = { $swap } Ansichten    { $map } Karte    { $large_map } große Karte    { $path } Bahn    Ziehen oder { $look_left } { $look_right } umsehen    Mausrad Zoom    { $follow } Drohne folgen
window-flight-keys-flight =
    { $arm } Motoren    { $take_off } starten    { $up } { $down } hoch, runter    { $turn_left } { $turn_right } drehen    { $forward } { $back } { $left } { $right } fliegen    { $lamp } Licht    { $snapshot } Foto    { $land } landen
    { $freeze } einfrieren    { $rewind } 10 s zurückspulen    { $walk } gehen
window-flight-keys-short = { $arm } Motoren    { $take_off } starten    { $pause } Pause; Tasten siehe dort
window-flight-keys-short-view = { $swap } Ansichten    { $map } Karte    { $follow } Drohne folgen

## Texts from `spandrel train`

window-train-form = { $title } (Variante { $form })
window-train-level = { $title } (Stufe { $level } von { $levels })
window-train-tasks =
    { $count ->
        [one] { $count } Aufgabe
       *[other] { $count } Aufgaben
    }
window-train-bridges =
    { $count ->
        [one] { $count } Brücke
       *[other] { $count } Brücken
    }
window-train-defects =
    { $count ->
        [one] { $count } Schaden
       *[other] { $count } Schäden
    }
window-train-lesson-progress =
    { $done } von { $steps ->
        [one] { $steps } Schritt
       *[other] { $steps } Schritten
    } der Lektion.
window-train-not-in-assessment = Im Bewertungsflug nicht möglich.
window-train-in-flight = Ein Flug läuft: Beenden Sie ihn zuerst.
window-train-no-window = Dieses Programm wurde ohne das Fenster gebaut
window-train-refused = Der Flug kann nicht beginnen: { $error }
window-train-no-briefing = Die Einweisung kann nicht gedruckt werden: { $error }
# A flight that an instructor has ordered at this station.
window-ordered = Ihr Ausbilder hat einen Flug für { $trainee } gewählt: { $job } ({ $purpose }).
window-ordered-declined = Sie haben den Flug abgelehnt, den Ihr Ausbilder gewählt hat.
