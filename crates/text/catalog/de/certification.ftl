certification-tasks-done = erledigte Aufgaben
certification-landed-at-home = am Landeplatz gelandet
certification-person-or-vehicle-hits = getroffene Personen und Fahrzeuge
certification-battery = Akku bei der Landung
certification-contacts = Berührungen
certification-contact-speed = schnellste Berührung
certification-conformity = Bahntreue
certification-precision = Präzision
certification-safety = Sicherheit
certification-accuracy = Genauigkeit
certification-practice-aids = Einfrieren und Zurückspulen

certification-at-least = mindestens { $limit }
certification-at-most = höchstens { $limit }
certification-points = { $value } Punkte
certification-yes = ja
certification-no = nein
certification-does-not-apply = entfällt
certification-no-evidence = kein Nachweis

certification-unmet-practice = { $aids }, daher ein Übungsflug
certification-unmet-hit = eine Person oder ein Fahrzeug wurde getroffen
certification-unmet-task-part = Aufgabe { $task } nicht erledigt: { $share }% der Bahn, { $needed }% nötig
certification-unmet-task-not-attempted = Aufgabe { $task } nicht begonnen
certification-unmet-landing = nicht am Landeplatz gelandet
certification-unmet-battery = { $battery } Akku bei der Landung, { $needed }% nötig
certification-unmet-contacts = Berührungen: { $contacts }, höchstens { $limit } erlaubt
certification-unmet-contact-speed = Berührung mit { $speed }, höchstens { $limit } erlaubt
certification-unmet-score = { $score ->
        [conformity] Bahntreue
        [precision] Präzision
        [safety] Sicherheit
        [accuracy] Genauigkeit
       *[other] { $score }
    } { $value }, { $needed } nötig
certification-unmet-no-evidence = kein Nachweis für: { $score ->
        [conformity] Bahntreue
        [precision] Präzision
        [safety] Sicherheit
        [accuracy] Genauigkeit
       *[other] { $score }
    }

certification-picture-of-defect = Schaden { $defect }: { $reason }
certification-picture-resolution = Auflösung { $value } mm/px, höchstens { $limit } mm/px
certification-picture-motion-blur = Bewegungsunschärfe { $value } px, höchstens { $limit } px
certification-picture-incidence = Aufnahmewinkel { $value }°, höchstens { $limit }°
certification-picture-too-fine = zu fein für diese Kamera
certification-picture-not-central = nicht in den mittleren 80% des Bildes
certification-picture-hidden = verdeckt
certification-picture-too-oblique = zu schräg: { $value }°, höchstens { $limit }°
certification-picture-too-small = zu klein: { $value } px, mindestens { $limit } px
certification-picture-line-too-thin = Linie zu dünn: { $value } px, mindestens { $limit } px
certification-picture-dark-lamp-on = zu dunkel: Scheinwerfer an, { $value } lx, nötig { $limit } lx
certification-picture-dark-lamp-off = zu dunkel: Scheinwerfer aus, { $value } lx, nötig { $limit } lx

certification-job-tasks = jede Aufgabe auf mindestens { $share }% ihrer Bahn geflogen
certification-job-landing = am Landeplatz mit mindestens { $battery }% Akku gelandet, keine Person und kein Fahrzeug getroffen
certification-job-aids = kein Einfrieren und kein Zurückspulen, denn das sind Übungshilfen
certification-job-contacts = Berührungen: höchstens { $contacts }, keine schneller als { $speed } m/s
certification-job-scores = Bahntreue mindestens { $conformity }, Präzision { $precision }, Sicherheit { $safety }, Genauigkeit { $accuracy }
certification-job-pictures = Bilder mit höchstens { $resolution } mm/px (bei einem Riss das { $width }-Fache der Breite), { $blur } px Bewegungsunschärfe und { $incidence }° Aufnahmewinkel
