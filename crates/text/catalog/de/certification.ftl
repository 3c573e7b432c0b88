certification-tasks-done = erledigte Aufgaben
certification-landed-at-home = am Landeplatz gelandet
certification-person-or-vehicle-hits = getroffene Personen und Fahrzeuge
certification-battery = Akku bei der Landung
certification-contacts = Berührungen
certification-contact-speed = schnellste Berührung
certification-conformity = abdeckungsgewichtete Bahntreue
certification-precision = Flugpräzision
certification-safety = aufprallgewichtete Sicherheit
certification-accuracy = Erkennungsgenauigkeit
certification-efficiency = Zeiteffizienz
certification-practice-aids = Einfrieren und Zurückspulen

certification-explain-tasks-done = Jede Aufgabe gilt als erledigt, sobald genug von ihrer Bahn geflogen ist.
certification-explain-landed-at-home = Der Flug muss mit einer Landung beim Bodenteam enden.
certification-explain-person-or-vehicle-hits = Personen und Fahrzeuge, auch geparkte, die die Drohne berührt hat.
certification-explain-battery = Die Ladung, die nach der Landung übrig ist.
certification-explain-contacts = Wie oft die Drohne Brücke, Boden oder Wasser berührt hat; Berührungen innerhalb einer Sekunde zählen einmal.
certification-explain-contact-speed = Die höchste Geschwindigkeit, mit der die Drohne etwas berührt hat.
certification-explain-conformity = Die Zeit auf der Bahn innerhalb des Tempolimits, gewichtet damit, wie viel von jeder Bahn geflogen wurde. Die TASBID-Wertung Bahntreue lässt ausgelassene Teile der Bahn außer Acht.
certification-explain-precision = Wie klein die Fehler bei Abstand zur Bahn, Geschwindigkeit, Kamerarichtung und Abstand zu Oberflächen während der Aufgaben waren.
certification-explain-safety = 100 Punkte abzüglich der Verluste für jede Berührung, die mit deren Geschwindigkeit wachsen, und für die Zeit zu nah an einer Oberfläche; 0, wenn eine Person oder ein Fahrzeug getroffen wurde.
certification-explain-accuracy = Der Anteil der gefundenen Schäden und der Anteil der Bilder, die einen zeigen, zusammengefasst. Anders als bei der TASBID-Wertung Genauigkeit zählen nur Bilder mit genug Details und wenig Unschärfe.
certification-explain-efficiency = Die Flugzeit im Vergleich zu der Zeit, die dieser Auftrag mit den gefundenen Schäden braucht.
certification-explain-practice-aids = Einfrieren und Zurückspulen sind Übungshilfen; ein zertifizierter Flug kommt ohne sie aus.

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
certification-unmet-one-contact = Berührungen: 1, höchstens { $limit } erlaubt
certification-unmet-contacts = Berührungen: { $contacts }, höchstens { $limit } erlaubt
certification-unmet-contact-speed = Berührung mit { $speed }, höchstens { $limit } erlaubt
certification-unmet-score = { $score } { $value }, { $needed } nötig
certification-unmet-no-evidence = kein Nachweis für: { $score }

certification-picture-resolution = Auflösung { $value } mm/px, höchstens { $limit } mm/px
certification-picture-motion-blur = Bewegungsunschärfe { $value } px, höchstens { $limit } px
certification-picture-incidence = Aufnahmewinkel { $value }°, höchstens { $limit }°
certification-picture-too-fine = zu fein für diese Kamera

certification-job-tasks = jede Aufgabe auf mindestens { $share }% ihrer Bahn geflogen
certification-job-landing = am Landeplatz mit mindestens { $battery }% Akku gelandet, keine Person und kein Fahrzeug getroffen
certification-job-aids = kein Einfrieren und kein Zurückspulen, denn das sind Übungshilfen
certification-job-contacts = Berührungen: höchstens { $contacts }, keine schneller als { $speed } m/s
certification-job-scores = abdeckungsgewichtete Bahntreue mindestens { $conformity }, Flugpräzision { $precision }, aufprallgewichtete Sicherheit { $safety }, Erkennungsgenauigkeit { $accuracy }
certification-job-scores-without-defects = abdeckungsgewichtete Bahntreue mindestens { $conformity }, Flugpräzision { $precision }, aufprallgewichtete Sicherheit { $safety }
certification-job-pictures = Bilder mit höchstens { $resolution } mm/px (bei einem Riss das { $width }-Fache der Breite), { $blur } px Bewegungsunschärfe und { $incidence }° Aufnahmewinkel
