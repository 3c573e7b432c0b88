## Page

report-title = Sitzungsbericht: { $trainee }, { $started }
report-kicker = Sitzungsbericht
report-sections = Abschnitte
report-print = Drucken
report-section-better = Besser machen
report-section-scores = Wertung
report-section-tasks = Aufgaben
report-section-next = Nächste Schritte
report-section-flight = Flug
report-section-pictures = Bilder
report-section-defects = Schäden
report-section-feedback = Rückmeldungen
report-section-coverage = Abdeckung
report-section-certification = Zertifizierung
report-section-record = Aufzeichnung

## Tables

report-table = Tabelle: { $caption }
report-table-download = Als CSV herunterladen

## Words

report-contact-grave = Person oder Fahrzeug
report-control-pilot = Fernpilot
report-control-mission = Mission
report-control-script = Skript
report-control-autopilot = Autopilot
report-control-unknown = unbekannt
report-between-tasks = zwischen den Aufgaben
report-on-path = auf der Bahn
report-off-path = neben der Bahn
report-task = Aufgabe { $task }
report-not-attempted = nicht begonnen
report-within-error = innerhalb des Messfehlers
report-beyond-error = außerhalb des Messfehlers
report-error-unknown = Messfehler unbekannt
report-measure-certification-sum = Summe der Zertifizierung
report-measure-flight-time = Flugzeit
report-measure-crashes = Kollisionen
report-unit-points = Punkte
report-measure-with-unit = { $measure } ({ $unit })
report-percent = { $value }%

## Column headings of several tables

report-column-task = Aufgabe
report-column-name = Name
report-column-state = Status
report-column-time = Zeit
report-column-time-s = Zeit (s)
report-column-with = mit
report-column-path = Bahn
report-column-path-flown = geflogene Bahn (%)
report-column-on-path-share = Anteil auf der Bahn (%)
report-column-speeding-loss = Abzug für Tempo
report-column-speed = Geschwindigkeit (m/s)
report-column-distance = Entfernung (m)
report-column-clearance = Abstand zum Bauwerk (m)
report-column-battery = Akku (%)
report-column-wind = Wind (m/s)
report-column-wind-from = Wind aus (Grad)
report-column-number = Nummer
report-column-place = Ort
report-column-added-air = Abweichung vom freien Wind (m/s)
report-column-added-updraft = davon aufwärts (m/s)
report-column-east = Ost (m)
report-column-north = Nord (m)
report-column-height = Höhe (m)
report-column-score = Wertung
report-column-points = Punkte
report-column-frame = Datensatz
report-column-element = Bauteil
report-column-condition-state = Zustandsstufe
report-column-cause = Ursache
report-column-kind = Art
report-column-found = gefunden
report-column-reason = Grund
report-column-scenario = Szenario
report-column-flight-time = Flugzeit
report-column-repetition = Wiederholung
report-column-change = Änderung
report-column-measurement-error = Messfehler
report-column-minimal-change = kleinste nachweisbare Änderung
report-column-pixel-size = Pixelgröße (mm)
report-column-angle = Winkel zur Normalen (Grad)
report-column-illuminance = Beleuchtungsstärke (lx)
report-column-blur = Bewegungsunschärfe (px)

## Header

report-skip = Zum Abschnitt „Besser machen“ springen
report-level = Stufe { $level } von { $levels }
report-flight-time = Flugzeit { $duration }, { $end }.
report-telemetry-covers = Die Telemetrie deckt { $share }% der Sitzung ab.
report-practice-aids = Diese Sitzung wurde { $aids }. Sie zählt als Übungsflug: Sie wird weder zertifiziert noch mit anderen verglichen.
report-of-max = von { $max }
report-out-of-sight = Für { $total } außer Sicht des Prüfers, davon am längsten für { $longest } ab { $from }.
report-gnss-lost = Für { $total } keine GNSS-Position, davon am längsten für { $longest } ab { $from }.
report-position-error = Die Drohne irrte sich in ihrer Position um bis zu { $position } m (bei { $at }), in ihrer Höhe um bis zu { $height } m (bei { $height_at }).
report-heading-error = In ihrer Richtung irrte sie sich um bis zu { $degrees }° (bei { $at }).
report-video-poor = Für { $total } schlechte Videoverbindung, davon am längsten für { $longest } ab { $from }.
report-control-lost =
    { $count ->
        [one] Steuerverbindung einmal verloren.
       *[other] Steuerverbindung { $count }-mal verloren.
    }
report-air-disturbed = Für { $total } in Luft, die eine Brücke stört (mindestens { $least } m/s Abweichung vom freien Wind), davon am längsten für { $longest } ab { $from }.
report-air-strongest = Am stärksten war die Störung bei { $at } { $place }: { $speed } m/s Abweichung vom freien Wind.
report-place-under = unter dem Überbau der Brücke „{ $bridge }“
report-place-above = über dem Überbau der Brücke „{ $bridge }“
report-place-beside = neben der Brücke „{ $bridge }“
report-flow-lost = Für { $total } kein optischer Fluss über Wasser, davon am längsten für { $longest } ab { $from }.
report-ranges-lost =
    { $count ->
        [one] Der Entfernungsmesser nach unten versagte bei seiner einzigen Messung über Wasser.
       *[other] Der Entfernungsmesser nach unten versagte bei { $lost } von { $count } Messungen über Wasser.
    }
report-cold-battery = Kalter Akku ({ $temperature } °C): bis zu { $missing } V weniger als bei 25 °C (bei { $at }, mit noch { $voltage } V) und { $share }% mehr Ladung verbraucht.
report-walks = Wege des Prüfers: { $walks }.
report-walk = zu Standort { $place } ab { $moment }
report-walk-before = zu Standort { $place } vor dem Abheben

## Air around the bridges

report-air-title = Luft um die Brücken
report-air-about = Die mittlere Luftströmung im Modell des Flugs, ohne Böen. Wirbel hinter Pfeilern und Überbauten sind gemittelt und zählen als Turbulenz. Farben und Pfeile zeigen die Geschwindigkeit in der Zeichenebene.
report-air-wind = Um die Brücke „{ $bridge }“ wehte der freie Wind in 6 m Höhe mit { $speed } m/s aus { $from }°.
report-air-level = Brücke „{ $bridge }“ von oben, { $height } m über dem Wasser: mittlere Höhe (Median) des Flugs an dieser Brücke
report-air-across = Brücke „{ $bridge }“ quer zum Überbau, { $station } m von der Mitte in Richtung { $toward }°, Blick in Richtung { $heading }°
report-air-places = Wo die Brücken die Luft um die Drohne am stärksten störten (Nummern in den Zeichnungen):
report-air-off = { $speed } m/s Abweichung vom freien Wind
report-air-caption = am stärksten gestörte Luft

## Scores

report-scores-part = Die folgenden Wertungen gelten nur für den geflogenen Teil.
report-scores-figure = Die vier Wertungen: 0 in der Mitte, 100 am Rand
report-scores-radar = Netzdiagramm der vier Wertungen
report-scores-caption = Wertungen
report-column-raw = Rohwert
report-column-score-of-100 = Wertung (von 100)
report-explain-battery-failed = nicht beim Bodenteam gelandet, bevor Akku oder Zeit zu Ende waren
report-explain-time = Flugzeit { $time }; volle Punktzahl bis { $best }
report-explain-no-contacts = keine Berührungen
report-explain-contacts =
    { $count ->
        [one] 1 Berührung, 3 Punkte Abzug
       *[other] { $count } Berührungen, je 3 Punkte Abzug
    }
report-explain-grave = Person oder Fahrzeug getroffen: 0 Punkte
report-explain-no-defects = keine Schäden in diesem Auftrag
report-explain-defects =
    { $found } von { $placed ->
        [one] { $placed } Schaden
       *[other] { $placed } Schäden
    } gefunden; { $hits } von { $taken ->
        [one] { $taken } Bild
       *[other] { $taken } Bildern
    } { $hits ->
        [one] zeigte
       *[other] zeigten
    } einen neuen Schaden
report-explain-no-tasks = keine Aufgaben in diesem Auftrag
report-explain-none-attempted = keine Aufgabe begonnen (die TASBID-Formel ergibt 50 Punkte)
report-explain-skipped =
    { $skipped } von { $tasks ->
        [one] { $tasks } Aufgabe
       *[other] { $tasks } Aufgaben
    } nicht begonnen
report-explain-lowest = geringster Anteil auf der Bahn: { $share }% (Aufgabe { $task }); { $speeding } s zu schnell

## Do better

report-better-show = { $moment } zeigen
report-better-picture = Bild { $picture }
report-better-practice = üben mit
report-better-next = Nächster Flug:

## Next

report-next-note = Nur auf Grundlage dieser Sitzung. Der Plan aus allen Sitzungen steht im Browser auf der Seite des Trainees.
report-next-consequence = Folge: { $reason }
report-next-caption = empfohlene Szenarien
report-column-level = Stufe
report-column-rule = Regel
report-column-consequence-of = Folge von
report-column-measured = gemessen
report-column-limit = Grenzwert
report-column-urgency = Dringlichkeit

## Certification

report-certification-intro = Das Zertifizierungsprofil ergänzt Anforderungen, die bestanden werden müssen und Lücken der vier TASBID-Wertungen schließen. Seine eigenen Wertungen haben andere Formeln als die TASBID-Wertungen und daher andere Namen.
report-certification-passed = Alle Anforderungen erfüllt.
report-certification-met = erfüllt
report-certification-not-met = nicht erfüllt
report-certification-unmet = Nicht erfüllt: { $requirements }.
report-certification-exposure =
    Näher als { $limit } m an einer Oberfläche für { $exposure } s; { $contacts ->
        [one] { $contacts } Berührung
       *[other] { $contacts } Berührungen
    } ({ $merged } nach Zusammenfassen der Berührungen innerhalb von weniger als einer Sekunde); am Ende { $battery }% Akku; Flugzeit { $time } (dieser Auftrag braucht mit den gefundenen Schäden { $needed }).
report-certification-too-fine =
    { $count ->
        [one] 1 Schaden ist zu fein für diese Kamera und zählt nicht für die Erkennungsgenauigkeit.
       *[other] { $count } Schäden sind zu fein für diese Kamera und zählen nicht für die Erkennungsgenauigkeit.
    }
report-certification-scores-caption = Wertungen der Zertifizierung
report-certification-contacts-caption = zusammengefasste Berührungen
report-certification-pictures-caption = Bilder nach Bildqualität
report-certification-visits-caption = Anflüge der Aufgaben
report-certification-detection-caption = gefundene Schäden nach Bauteil, Art und Zustandsstufe
report-certification-hit = Treffer
report-certification-no-hit = kein Treffer
report-certification-not-counted = nicht gezählt
report-column-points-lost = Punktabzug
report-column-result = Ergebnis
report-column-new-defects = neue Schäden
report-column-fails = warum Schäden im Bild nicht zählten
report-column-visits = Anflüge
report-column-rms-distance = RMS-Entfernung / Schwelle
report-column-rms-speed = RMS-Überschreitung des Tempolimits / Limit
report-column-rms-framing = RMS-Fehler der Ausrichtung (Grad)
report-column-too-close-share = zu nah (% der Zeit)
report-column-grouped-by = gruppiert nach
report-column-value = Wert
report-column-placed = vorhanden

## Tasks

report-tasks-shares = Anteil der Zeit jeder Aufgabe auf der Bahn und über dem Tempolimit
report-tasks-on-path = auf der Bahn
report-tasks-speeding = über dem Tempolimit
report-tasks-shares-title = Anteil auf der Bahn und Tempoüberschreitung nach Aufgabe
report-tasks-contacts = Berührungen nach Aufgabe und Objekt
report-tasks-no-contacts = Keine Berührungen.
report-tasks-contacts-title = Berührungen nach Aufgabe und Art
report-tasks-done = erledigt
report-tasks-part = teilweise geflogen
report-tasks-caption = Aufgaben
report-tasks-contacts-caption = Berührungen
report-column-off-path-time = Zeit neben der Bahn (s)
report-column-speeding-time = Zeit über dem Tempolimit (s)
report-column-mean-distance = mittlere Entfernung (m)
report-column-max-distance = größte Entfernung (m)
report-column-max-speed = größte Geschwindigkeit (m/s)
report-column-min-clearance = kleinster Abstand zum Bauwerk (m)

## Defects

report-defects-none = Dieser Auftrag hat keine Schäden.
report-defects-count =
    { $found } von { $placed ->
        [one] { $placed } Schaden
       *[other] { $placed } Schäden
    } { $found ->
        [one] wurde
       *[other] wurden
    } gefunden.
report-defects-found = gefunden
report-defects-missed = nicht gefunden
report-defects-missed-head = Nicht gefundene Schäden
report-defects-drawn = Jede Zeichnung zeigt den Schaden aus 4 m Entfernung, frontal und mit Scheinwerfer.
report-defects-drawing = Schäden: { $title }
report-defects-side = Seitenansicht der Brücke „{ $bridge }“
report-defects-top = Draufsicht der Brücke „{ $bridge }“
report-defects-alt = Schaden { $defect }, aus 4 m Entfernung gesehen
report-defects-number = Schaden { $defect }
report-defects-kind = { $kind }, Zustandsstufe { $state }
report-defects-place = An { $member } ({ $element }), { $size }.
report-defects-cause = Ursache: { $cause }.
report-defects-size-line = { $length } cm lang, { $width } mm breit
report-defects-size-area = { $length } × { $width } cm
report-defects-outcome = Er wurde { $outcome }.
report-defects-picture = Bild { $picture }
report-defects-found-plain = gefunden
report-defects-found-by = in Bild { $picture } gefunden
report-defects-in-view = { $seconds } s lang deutlich gezeigt, zuerst bei { $moment }, aber nicht fotografiert
report-defects-best-seen = am besten bei { $moment } gezeigt, aber: { $reasons }
report-defects-never = nie von der Kamera erfasst; die Drohne kam bei { $moment } auf { $distance } m heran
report-defects-caption = Schäden
report-column-defect = Schaden
report-column-element-name = Bauteilname
report-column-member = Einzelbauteil
report-column-length-mm = Länge (mm)
report-column-width-mm = Breite (mm)
report-column-visible-time = Zeit deutlich sichtbar (s)
report-column-closest = größte Annäherung (m)
report-column-outcome = Ergebnis

## Pictures

report-pictures-none = Es wurden keine Bilder aufgenommen.
report-pictures-drawn = Die Sitzung enthält keine Fotos; jede Ansicht ist aus der Geometrie der Brücke gezeichnet. Nur Schäden im gestrichelten Rahmen zählen.
report-pictures-count =
    { $count ->
        [one] { $count } Bild
       *[other] { $count } Bilder
    }: { $verdicts }.
report-pictures-count-hit = { $count } Treffer
report-pictures-count-repeat =
    { $count ->
        [one] { $count } Wiederholung
       *[other] { $count } Wiederholungen
    }
report-pictures-count-too-dark = { $count } zu dunkel
report-pictures-count-too-far = { $count } zu weit entfernt
report-pictures-count-too-oblique = { $count } zu schräg
report-pictures-count-false = { $count } ohne Schaden
report-verdict-hit = Treffer
report-verdict-repeat = Wiederholung
report-verdict-too-dark = zu dunkel
report-verdict-too-far = zu weit entfernt
report-verdict-too-oblique = zu schräg
report-verdict-false = ohne Schaden
report-verdict-near = knapp verfehlt
report-reason-first = zeigt Schaden { $defects } zum ersten Mal
report-reason-again = Schaden { $defects } wurde schon fotografiert
report-reason-none = kein Schaden sichtbar
report-reason-occluded = kein Schaden sichtbar (Schaden { $defect } ist verdeckt)
report-picture-number = Bild { $picture }
report-picture-at = bei { $moment }
report-picture-at-task = bei { $moment }, Aufgabe { $task }
report-picture-alt = Bild { $picture }: { $reason }
report-picture-lamp-on = Scheinwerfer an
report-picture-lamp-off = Scheinwerfer aus
report-picture-sky = Bildmitte: Himmel, { $lamp }
report-picture-center = Bildmitte: { $name }, { $distance } m entfernt, { $angle }° zur Flächennormalen, { $pixel } mm pro Pixel, { $illuminance } lx ({ $lamp }), Bewegungsunschärfe { $blur } px
report-pictures-sky = Himmel
report-pictures-on = an
report-pictures-off = aus
report-pictures-caption = Bilder
report-column-picture = Bild
report-column-verdict = Bewertung
report-column-image-center = Bildmitte
report-column-required-illuminance = nötige Beleuchtungsstärke (lx)
report-column-lamp = Scheinwerfer

## Flight

report-chart-speed = Geschwindigkeit (m/s)
report-chart-distance = Entfernung zur Bahn der aktuellen Aufgabe (m)
report-chart-clearance = Abstand zur nächsten Oberfläche (m)
report-chart-battery = Akku (%)
report-chart-wind = Horizontaler Wind an der Drohne (m/s)
report-chart-sticks = Knüppelstellungen (voller Ausschlag = 1)
report-chart-label = { $title } im Zeitverlauf; Werte in der Tabelle darunter
report-flight-timeline = Zeitleiste der Sitzung
report-flight-timeline-region = Zeitleiste
report-flight-timeline-title = Steuerung, Aufgaben, Rückmeldungen, Bilder und Lücken im Zeitverlauf
report-flight-zoom = Ziehen Sie über ein Diagramm, um es zu vergrößern. Doppelklicken Sie, um die Vergrößerung aufzuheben. Klicken Sie, um den Schieberegler zu bewegen.
report-flight-series = Zeitreihen als CSV herunterladen
report-flight-export = Alle Einzelbilder: { $link } auf der Seite der Sitzung im Browser.
report-flight-marks = Markierungen der Ausbilder
report-flight-play = Abspielen
report-flight-pause = Pause
report-flight-time-label = Zeit
report-readout-task = Aufgabe
report-readout-path = Bahn
report-readout-distance = Entfernung
report-readout-speed = Geschwindigkeit
report-readout-clearance = Abstand
report-readout-battery = Akku
report-flight-color = Flugweg färben nach
report-flight-video = Kamerabild
report-flight-video-missing = Das Video kann von hier nicht geladen werden. Es ist auch auf der Seite der Sitzung und im Sitzungsordner ({ $file }).
report-flight-reference = Sollbahn
report-flight-contact = Berührung
report-flight-picture-hit = Bild: Treffer
report-flight-plan = Von oben, Norden oben
report-flight-plan-region = Grundriss
report-flight-south = Ansicht von Süden
report-flight-elevation-region = Ansicht
report-flight-side = Seitenansicht der Brücke „{ $bridge }“ mit dem nahen Flugweg
report-flight-3d = 3D-Ansicht
report-flight-rotate = Drehen
report-flight-3d-region = 3D-Ansicht des Flugs
report-flight-3d-note = Ziehen Sie oder drehen Sie mit den Pfeiltasten. Vergrößern Sie mit den Tasten + und − oder dem Mausrad.
report-flight-3d-label = 3D-Modell des Einsatzorts und des Flugwegs. Pfeiltasten drehen es, Plus und Minus vergrößern und verkleinern.
report-flight-slider = { $moment }, Aufgabe { $task }, { $path }
report-timeline-pilot = von Hand geflogen
report-timeline-other = von Mission, Skript oder Autopilot geflogen
report-timeline-task = Aufgabe
report-timeline-cue = Warnung
report-timeline-gap = keine Telemetrie
report-timeline-flown-by = Steuerung
report-timeline-episode = { $cue } von { $from } bis { $to }
report-timeline-picture = Bild { $picture }: { $verdict }
report-timeline-pictures = Bilder
report-timeline-note = Notiz: { $note }
report-timeline-notes = Notizen
report-timeline-mark = Markierung: { $mark }
report-timeline-marks = Markierungen
report-timeline-gaps = Lücken
report-timeline-gap-for = { $seconds } s lang keine Telemetrie
report-timeline-gap-to-end = keine Telemetrie bis zum Ende
report-stick-turn-clockwise = Drehung im Uhrzeigersinn
report-stick-turn = Drehung
report-flight-caption = Flugdaten, alle paar Sekunden

## Feedback

report-cue-crash = Kollision
report-cue-too-close = zu nah
report-cue-speeding = zu schnell
report-cue-stand-off = Abstand
report-cue-off-path = Abweichung
report-cue-battery-yellow = Akku gelb
report-cue-battery-red = Akku rot
report-feedback-none = Es gab keine Rückmeldungen.
report-feedback-region = Übersicht der Rückmeldungen
report-feedback-figure = Zeit von der Warnung bis zur ersten Knüppelbewegung; jeder Punkt ist eine Warnung; der Strich zeigt den Median
report-feedback-reactions-region = Reaktionszeiten
report-feedback-reactions = Reaktionszeiten nach Warnung
report-feedback-note = Eine Reaktion ist eine Knüppelbewegung um mindestens 10% des vollen Ausschlags innerhalb von 5 s nach der Warnung. Wurde ein Knüppel schon bewegt, kann das zufällig als Reaktion zählen.
report-feedback-answers = { $answers } von { $count }
report-feedback-caption = gezeigte Rückmeldungen
report-feedback-texts-caption = gesendete Meldungen
report-feedback-notes-caption = Notizen der Ausbilder
report-feedback-before = vor dem Abheben
report-column-feedback = Rückmeldung
report-column-count = Anzahl
report-column-total-duration = Gesamtdauer (s)
report-column-stick-reactions = Knüppelreaktionen
report-column-median-reaction = mittlere Reaktionszeit (Median, s)
report-column-duration = Dauer (s)
report-column-reaction-time = Reaktionszeit (s)
report-column-text = Text
report-column-note = Notiz

## Coverage

report-coverage-shown = gut erfasst
report-coverage-blurred = unscharf
report-coverage-dark-on = zu dunkel, Scheinwerfer an
report-coverage-dark-off = zu dunkel, Scheinwerfer aus
report-coverage-oblique = zu schräg
report-coverage-far = zu weit entfernt
report-coverage-unpictured = im Blick, nicht fotografiert
report-coverage-unseen = nie im Blick
report-coverage-none = Von den Sollbahnen aus lässt sich keine Brückenoberfläche prüfen; alle Oberflächen liegen außerhalb der Reichweite der Kamera.
report-coverage-summary = Die Bilder erfassen { $share } der prüfbaren Brückenoberfläche gut ({ $area } m² lassen sich von den Sollbahnen aus prüfen).
report-coverage-rest = Der Rest: { $reasons }.
report-coverage-reason = { $share }% { $outcome }
report-coverage-note = Eine Oberfläche ist prüfbar, wenn sie von mindestens einem Punkt einer Sollbahn mit { $pixel } mm pro Pixel oder feiner (bei dieser Auflösung bedeckt ein 1.27 mm breiter Riss, die Grenze zwischen den Zustandsstufen 2 und 3, ein halbes Pixel; diese Kamera erreicht sie aus bis zu { $reach } m Entfernung) und in einem Winkel von höchstens { $angle }° zur Flächennormalen sichtbar ist. Sie ist gut erfasst, wenn ein Bild beide Grenzen einhält, genug Licht (einschließlich Scheinwerfer) für eine Belichtung innerhalb der Grenzen der Kamera hat und höchstens { $blur } px Bewegungsunschärfe aufweist. Zeigen mehrere Bilder dieselbe Stelle, zählt das beste.
report-coverage-figure = Abdeckung der prüfbaren Oberfläche jedes Bauteils
report-coverage-bars = Abdeckung der Oberfläche nach Bauteil
report-coverage-bars-continued = Abdeckung der Oberfläche nach Bauteil, Fortsetzung
report-coverage-all = alle
report-coverage-caption = Abdeckung der Oberfläche; Pixelgröße, Winkel, Licht und Unschärfe sind Mittelwerte der Bilder mit der nötigen Auflösung und dem nötigen Winkel
report-column-inspectable = prüfbare Fläche (m²)
report-column-area = { $outcome } (m²)

## Record

report-record-frames-note = In Lücken über 1 s wiederholen fehlende Datensätze die letzte bekannte Position und werden dort gewertet.
report-record-files-note = Dieser Bericht wird aus der Telemetrie, der Szenariodatei und der Fluggerätedatei berechnet. Dieselben drei Dateien ergeben immer denselben Bericht.
report-record-no-gaps = Die Telemetrie hat keine Lücken über 0.2 s.
report-record-gaps = Telemetrielücken über 0.2 s: { $gaps }. Interpolierte Datensätze: { $interpolated }. Fehlende Datensätze: { $missing }. Die Telemetrie deckt { $share }% der Sitzung ab.
report-record-control-caption = Steuerung im Zeitverlauf
report-record-caption = Sitzungsdaten
report-column-from = von
report-column-to = bis
report-column-flown-by = Steuerung
report-column-item = Angabe
report-record-session = Sitzung
report-record-trainee = Trainee
report-record-purpose = Zweck
report-record-no-purpose = nicht angegeben
report-record-started = Beginn
report-record-scenario = Szenario
report-record-scenario-hash = SHA-256 des Szenarios
report-record-aircraft = Fluggerät
report-record-aircraft-hash = SHA-256 des Fluggeräts
report-record-telemetry-hash = SHA-256 der Telemetrie
report-record-seed = Startwert
report-record-scorer = Bewertungsprogramm
report-record-frames = gewertete Datensätze
report-record-received = empfangene MAVLink-Pakete
report-record-lost = verlorene Pakete
report-record-duplicate = doppelte Pakete
report-record-reordered = Pakete in falscher Reihenfolge

## Briefing

report-briefing-title = Einweisung: { $title }
report-briefing-lead = Einweisung zum Auftrag { $job }
report-briefing-notes = Von Ihrem Ausbilder
report-briefing-pictures = Bilder von Ihrem Ausbilder
report-briefing-picture-missing = Das Bild { $file } fehlt.
report-briefing-site = Einsatzort
report-briefing-tasks = Aufgaben in dieser Reihenfolge
report-briefing-conditions = Bedingungen
report-briefing-hazards = Gefahren
report-briefing-counts = Was zählt
report-briefing-check = Kontrolle des Einsatzorts vor dem Start
report-briefing-above = Von oben, Norden oben
report-briefing-side = Brücke „{ $bridge }“ von der Seite
report-briefing-south = Von Süden
report-briefing-task-region = Aufgaben
report-briefing-task = Aufgabe
report-briefing-where = Ort
report-briefing-length = Länge (m)
report-briefing-height = Höhe über dem Landeplatz (m)
report-briefing-stand-off = Abstand (m)
report-briefing-lamp = Scheinwerfer
report-briefing-lamp-needed = nötig
report-briefing-heights = { $low } bis { $high }

## Progress

report-progress-repetition = Wiederholung { $repetition }
report-progress-scores = Die vier Wertungen nach Wiederholung
report-progress-scores-title = Wertungen nach Wiederholung
report-progress-shares = Anteil auf der Bahn nach Aufgabe (%)
report-progress-shares-title = Anteil auf der Bahn nach Aufgabe und Wiederholung
report-progress-crashes = Kollisionen nach Objekt
report-progress-crashes-none = Keine.
report-progress-crashes-title = Kollisionen nach Art und Wiederholung
report-progress-curves = Lernkurven
report-progress-curve = Lernkurve: { $score }
report-progress-curves-note = Jede Kurve ist eine Anpassung des Potenzgesetzes der Übung an die Wiederholungen. Der Ring zeigt die Vorhersage für die nächste Wiederholung; sie kann über der höchsten Wertung liegen.
report-progress-curves-caption = Lernkurven (Wertung = erste Wertung × Wiederholung ^ Exponent)
report-progress-changes-caption = Änderungen seit der vorherigen Wiederholung
report-progress-caption = Wertungen, Zeit und Kollisionen nach Wiederholung
report-progress-on-path-caption = Anteil auf der Bahn nach Aufgabe
report-progress-too-few = Eine Lernkurve braucht { $count } Wiederholungen desselben Auftrags.
report-column-repetitions = Wiederholungen
report-column-first = erste
report-column-exponent = Exponent
report-column-next = nächste
report-column-bridge-crashes = Kollisionen mit der Brücke
report-column-ground-crashes = Kollisionen mit dem Boden
report-column-water-crashes = Kollisionen mit Wasser
report-column-other-crashes = sonstige Kollisionen
report-column-grave-crashes = Kollisionen mit Personen oder Fahrzeugen

## Learning management system

report-scorm-result = { $points } von 100. { $verdict }
report-scorm-missing = Kein Lernmanagementsystem gefunden.
report-scorm-sent = Ergebnis an das Lernmanagementsystem gesendet.
report-scorm-refused = Das Lernmanagementsystem hat das Ergebnis nicht angenommen.
