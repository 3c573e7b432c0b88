people-trainees = Trainees
people-pseudonym = Pseudonym
people-role = Rolle
people-age = Alter
people-drones = Drohnen
people-games = Spiele
people-no-trainees = Noch keine Trainees. Trainees erscheinen hier nach ihrem ersten Flug.
people-users =
    { $count ->
        [one] { $count } Person
       *[other] { $count } Personen
    }
people-plan-rules = Regeln der Trainingspläne
people-rubric = Bewertungsraster
people-experience-none = keine
people-experience-some = etwas
people-experience-regular = regelmäßig

people-trainee = Trainee { $name }
people-assignments = Zugewiesene Aufträge
people-next-flights = Nächste Flüge
people-progress = Fortschritt
people-sessions = Sitzungen
people-no-sessions = Noch keine Sitzungen.
people-details = Angaben
people-data = Daten
people-download = Alle Daten von { $name } herunterladen
people-of-classes =
    { $count ->
        [one] Klasse:
       *[other] Klassen:
    }
people-plan-between = Fliegen Sie zwischen { $from } und { $until }.
people-plan-overdue = Der letzte Flug liegt lange zurück, und ohne Übung lassen Fertigkeiten nach.
people-plan-consequence = Folge: { $reason }
people-plan-drills = Übungen
people-plan-drill = { $drill }: { $progress }.
people-plan-drill-next = { $drill }: { $progress }; nächste Stufe: { $level }.
people-changes = Änderungen
people-changes-compared = Verglichen mit { $session }.
people-changes-session = der vorherigen Sitzung beim selben Auftrag
people-changes-forms = Damals war es die Variante { $before }, jetzt die Variante { $now }; beide sind gleich schwierig.
people-change-better = { $what }: { $before } → { $now }, besser
people-change-worse = { $what }: { $before } → { $now }, schlechter
people-include-incomplete = Unvollständige Sitzungen einbeziehen
people-exclude-incomplete = Unvollständige Sitzungen ausschließen
people-job-sessions =
    { $count ->
        [one] { $count } Sitzung
       *[other] { $count } Sitzungen
    }
people-details-note = Rolle: { $role }. Die folgenden Angaben sind freiwillig und werden nur für die Studie verwendet.
people-not-specified = keine Angabe
people-age-years = Alter (Jahre)
people-drone-experience = Erfahrung mit Drohnen
people-gaming-experience = Erfahrung mit Videospielen
people-save = Speichern
people-details-changed = Diese Angaben wurden an anderer Stelle geändert: Laden Sie die Seite neu und prüfen Sie die aktuellen Angaben.
people-erase = Löschen
people-erase-note = Dies löscht { $name } mit allen Sitzungen, Antworten und Sitzungsordnern. Dies kann nicht rückgängig gemacht werden.
people-erase-again = Geben Sie zur Bestätigung das Pseudonym ein
people-erase-button = Endgültig löschen
people-erase-wrong-name = Das eingegebene Pseudonym ist nicht { $name }: Es wurde nichts gelöscht.
people-erase-self = Sie würden sich selbst aussperren: Bitten Sie einen anderen Administrator, Sie zu löschen.

people-classes = Klassen
people-no-classes = Noch keine Klassen.
people-class-count =
    { $count ->
        [one] { $count } Klasse
       *[other] { $count } Klassen
    }
people-class = Klasse
people-members = Mitglieder
people-new-class = Neue Klasse
people-name = Name
people-new-class-note = Buchstaben, Ziffern, - und _. Ein Trainee kann in mehreren Klassen sein.
people-create-class = Klasse anlegen
people-class-title = Klasse { $name }
people-no-members = Noch keine Trainees in dieser Klasse.
people-no-class-jobs = Dieser Klasse sind keine Aufträge zugewiesen.
people-assign-to-class = Dieser Klasse einen Auftrag zuweisen
people-add-trainees = Trainees hinzufügen
people-add-pseudonyms = Pseudonyme, durch Leerzeichen oder Kommas getrennt
people-add-note = Sie können Trainees vor ihrem ersten Flug hinzufügen.
people-add-button = Zur Klasse hinzufügen
people-delete = Löschen
people-delete-this-class = Diese Klasse löschen
people-delete-note = Dies löscht die Klasse und ihre Zuweisungen. Die Trainees und ihre Sitzungen bleiben erhalten.
people-delete-class = Klasse löschen
people-head-trainee = Trainee
people-head-last = Letzte Sitzung
people-head-certified = Zertifiziert
people-head-next = Als Nächstes empfohlen
people-head-open = Offene Aufträge
people-head-change = Ändern
people-not-flown = noch nicht geflogen
people-remove = Entfernen
people-remove-member = { $name } aus dieser Klasse entfernen
people-trainee-count =
    { $count ->
        [one] { $count } Trainee
       *[other] { $count } Trainees
    }
people-job-level = { $job }, Stufe { $level }
people-class-name = name = { $name }: ungültiger Klassenname (zulässig: 1 bis 32 Buchstaben ohne Umlaute, Ziffern, „-“ oder „_“, am Anfang ein Buchstabe oder eine Ziffer)
people-class-exists = name = { $name }: Es gibt bereits eine Klasse mit diesem Namen.
people-too-many-members =
    { $count ->
        [one] trainees: { $count } Pseudonym (zulässig: 1 bis { $most } auf einmal)
       *[other] trainees: { $count } Pseudonyme (zulässig: 1 bis { $most } auf einmal)
    }
people-lookalike = trainees: Es gibt kein „{ $name }“, aber einen Trainee „{ $other }“; verwenden Sie dieses Pseudonym.

people-no-open = Keine offenen Aufträge.
people-open-count =
    { $count ->
        [one] { $count } offener Auftrag
       *[other] { $count } offene Aufträge
    }
people-done-count = Erledigt ({ $count })
people-finished = Erledigte Aufträge
people-assign-to = { $name } einen Auftrag zuweisen
people-job = Auftrag
people-due = Fällig
people-state = Status
people-assigned-to = Zugewiesen an
people-to-fly = Zum Fliegen
people-change = Ändern
people-assigned-by = { $target }, von { $instructor }
people-job-level-or-harder = { $job }, Stufe { $level } oder schwerer
people-job-form = { $job }, Variante { $form }
people-target-class = Klasse { $name }
people-remove-assignment = Zuweisung von { $job } entfernen
people-none = keine
people-overdue-since = überfällig seit { $day }
people-due-on = fällig am { $day }
people-done = Erledigt
people-open = Offen
people-overdue = Überfällig
people-assignment-count =
    { $count ->
        [one] { $count } Zuweisung
       *[other] { $count } Zuweisungen
    }
people-assign = Zuweisen
people-assign-job-to = { $job } an { $name } zuweisen
people-choice-levels = { $job } (Stufen { $first } bis { $last })
people-choice-forms = { $job } (Varianten { $forms })
people-assign-note = Die Zuweisung ist erledigt nach dem ersten vollständigen Flug des Auftrags, der nach der Zuweisung beginnt.
people-assign-variant = Stufe oder Variante (optional)
people-assign-variant-note = Eine schwerere Stufe zählt auch. Ohne Stufe oder Variante zählt jede.
people-assign-due = Fällig (Ende des Tages, UTC)
people-assign-title-trainee = Trainee { $name } einen Auftrag zuweisen
people-assign-title-class = Klasse { $name } einen Auftrag zuweisen
people-assign-one-target = Entweder ein Trainee oder eine Klasse ist erforderlich.
people-assign-variant-unknown = variant = { $value }: unbekannte Stufe oder Variante von { $job } (zulässig: { $allowed })
people-assign-no-variants = variant = { $value }: unbekannte Stufe oder Variante von { $job } (der Auftrag hat keine Stufen oder Varianten)
people-assign-due-invalid = due = { $value }: ungültiges Datum (zulässig: { $first } bis { $last })

people-rubric-count = { $signed } von { $all } Kriterien bestätigt
people-rubric-of = Bewertungsraster von { $name }
people-criteria = Kriterien
people-history = Verlauf
people-no-history = Noch nichts bestätigt.
people-edit-criteria = Kriterien bearbeiten
people-signed = Bestätigt
people-signed-by = { $signed } am { $day } von { $instructor }
people-signed-by-with-note = { $signed } am { $day } von { $instructor }: { $note }
people-not-signed = Nicht bestätigt
people-withdraw = Zurückziehen
people-note-optional = Notiz (optional)
people-sign = Bestätigen
people-reason = Grund
people-withdraw-sign-off = Bestätigung zurückziehen
people-your-name = Ihr Name
people-button-for = { $button }: { $criterion }
people-erased-user = gelöschte Person
people-time = Zeit
people-criterion = Kriterium
people-action = Aktion
people-by = Von
people-note = Notiz
people-history-count =
    { $count ->
        [one] { $count } Eintrag, neuester zuerst
       *[other] { $count } Einträge, neueste zuerst
    }
people-rubric-own = Die Kriterien, die Ausbilder für jeden Trainee bestätigen. Dieser Server verwendet ein eigenes Bewertungsraster.
people-rubric-shipped = Die Kriterien, die Ausbilder für jeden Trainee bestätigen. Dieser Server verwendet das mitgelieferte Bewertungsraster.
people-rubric-note = Bestätigungen gehören zur ID eines Kriteriums. Wenn Sie ein Kriterium entfernen, bleiben seine Bestätigungen im Verlauf.
people-rubric-edit = Bearbeiten
people-rubric-toml = Bewertungsraster (TOML)
people-rubric-reset = Mitgeliefertes Bewertungsraster
people-rubric-delete = Eigenes Bewertungsraster löschen
people-rubric-saved = Das Bewertungsraster wurde gespeichert und gilt ab jetzt.
people-rubric-invalid = Das eigene Bewertungsraster dieses Servers ist ungültig; deshalb gilt das mitgelieferte. Ausbilder können es korrigieren.
people-already-signed = { $criterion }: bereits bestätigt; laden Sie die Seite neu
people-already-withdrawn = { $criterion }: bereits zurückgezogen; laden Sie die Seite neu

people-answer-invalid = { $field } = { $value }: ungültige Antwort (zulässig: { $least } bis { $most })
people-answer-invalid-step = { $field } = { $value }: ungültige Antwort (zulässig: { $least } bis { $most } in Schritten von { $step })

people-cohort = Kohorte
people-cohort-scenarios = Einbezogene Szenarien
people-cohort-repetitions = Wiederholungen
people-cohort-show = Anzeigen
people-cohort-download = Als Offline-Seite herunterladen
people-cohort-nothing = Für diese Szenarien gibt es keine Sitzungen.
