## Speed, battery, readouts

flight-speed-limit = max. { $limit }
flight-battery-no-data = keine Akkudaten
flight-battery-unknown = Akku ?
flight-readout-height = Höhe
flight-readout-home = Home
flight-readout-gimbal = Gimbal
flight-readout-time-left = Restzeit
flight-readout-lamp = Licht
flight-readout-lamp-on = ein
flight-readout-lamp-off = aus
flight-readout-pictures = Bilder
flight-readout-zoom = Zoom

## Status

flight-status-no-mode = kein Modus
flight-status-gnss-count = GNSS { $count }
flight-status-gnss-ok = GNSS ok
flight-status-gnss-lost-count = GNSS weg ({ $count })
flight-status-gnss-lost = GNSS weg
flight-status-gnss-unknown = GNSS ?
flight-status-link-ok = Link ok
flight-status-link-lost = LINK WEG { $age }
flight-status-frozen = EINGEFROREN
flight-status-signal-control = Steuerung
flight-status-signal-video = Video
flight-status-control-weak = STEUERUNG SCHWACH
flight-status-video-weak = VIDEO SCHWACH

## The next step of the job

flight-step-take-off = Starten
flight-step-return-to-task = Bahn verlassen: zurück zu Aufgabe { $task } von { $tasks }
flight-step-fly-to-task = Zu Aufgabe { $task } von { $tasks } fliegen
flight-step-fly-to = Zur Aufgabe fliegen
flight-step-inspect-task = Aufgabe { $task } von { $tasks } prüfen
flight-step-inspect = Prüfen
flight-step-fly-home = Zurückfliegen
flight-step-land = Auf dem Landeplatz landen
flight-step-over = Sitzung beendet
flight-step-hold-task = Position halten: Aufgabe { $task } von { $tasks }
flight-step-hold = Position halten
flight-way-ahead = { $distance }, geradeaus
flight-way-behind = { $distance }, hinter Ihnen
flight-way-left = { $distance }, { $angle } links
flight-way-right = { $distance }, { $angle } rechts
flight-panel-height = Höhe
flight-panel-path = Bahn
flight-panel-stand-off = Abstand
flight-panel-time = Zeit
flight-panel-time-of = { $flown } von { $needed }
flight-height-level = gleiche Höhe
flight-height-up = { $height } höher
flight-height-down = { $height } tiefer
flight-deviation-above = { $distance }, { $height } darüber
flight-deviation-below = { $distance }, { $height } darunter

## Lessons

flight-lesson-complete = Lektion abgeschlossen
flight-lesson-step = Schritt { $step } von { $steps }
flight-lesson-arm = Motoren starten
flight-lesson-take-off = Auf { $height } Höhe steigen
flight-lesson-hover = { $time } im Ring schweben
flight-lesson-turn = Um { $angle } drehen
flight-lesson-fly-path = Der Bahn folgen
flight-lesson-stop-at = { $time } im Ring anhalten
flight-lesson-tilt-down = Kamera { $angle } nach unten neigen
flight-lesson-tilt-up = Kamera { $angle } nach oben neigen
flight-lesson-lamp = Scheinwerfer einschalten
flight-lesson-photograph = Einen Schaden fotografieren
flight-lesson-fly-home = Zum Landeplatz zurückfliegen
flight-lesson-land = Auf dem Landeplatz landen
flight-lesson-done = Alle Schritte erledigt
flight-how-arm = Drücken Sie { $arm }. Die Propeller laufen an.
flight-how-take-off = Drücken Sie { $take_off }, oder halten Sie { $up } zum Steigen.
flight-how-hover = Fliegen Sie mit { $forward } { $left } { $back } { $right }, { $up } und { $down } hin, dann alle Tasten loslassen.
flight-how-turn = Halten Sie { $turn_left } oder { $turn_right }.
flight-how-fly-path = Folgen Sie dem Band durch die Tore: { $forward } { $left } { $back } { $right }, { $up } und { $down }.
flight-how-stop-at = Lassen Sie die Tasten früh los: Die Drohne hat einen Bremsweg.
flight-how-tilt-camera = Drücken Sie mehrmals { $gimbal_up } (nach oben) oder { $gimbal_down } (nach unten).
flight-how-lamp = Drücken Sie { $lamp }.
flight-how-photograph = Bringen Sie den Schaden zwischen die Eckmarken und drücken Sie { $snapshot }.
flight-how-fly-home = Das weiße Quadrat im Kompass zeigt den Weg.
flight-how-land = Drücken Sie { $land } über dem Landeplatz, oder halten Sie { $down }, bis die Motoren stehen.
flight-how-start = Drücken Sie { $arm }, um die Motoren zu starten, dann { $take_off }.
flight-how-done = Sie sind bereit für die erste Übung.
flight-remark-motors-off = Die Motoren sind aus: erneut starten
flight-remark-left-ring = Ring verlassen: { $time } bleiben
flight-remark-no-defect = Kein Schaden im Bild

## Warnings

flight-cue-crash = Kollision
flight-cue-too-close = Zu nah
flight-cue-speeding = Zu schnell
flight-cue-stand-off = Abstand
flight-cue-off-path = Abweichung
flight-cue-battery = Akku
flight-warning-crash = { $name }: { $object }
flight-warning-too-close = { $name }: { $distance }, mindestens { $limit }
flight-warning-speeding = { $name }: { $speed }, höchstens { $limit }
flight-warning-stand-off-small = { $name } zu klein: { $distance }, empfohlen { $recommended }
flight-warning-stand-off-large = { $name } zu groß: { $distance }, empfohlen { $recommended }
flight-warning-off-path = { $name } { $distance }: { $direction }
flight-warning-battery = { $name } { $level }
flight-directions-two = { $first } und { $second }
flight-directions-three = { $first }, { $second } und { $third }
flight-object-member = Bauteil { $name }
flight-object-pad = Landeplatz
flight-object-inspector = Prüfer
flight-object-crew-truck = Einsatzfahrzeug
flight-object-car = Pkw { $number }
flight-object-truck = Lkw { $number }
flight-object-pedestrian = Fußgänger { $number }
flight-spoken-meters = Meter
flight-spoken-feet = Fuß
flight-spoken-miles-per-hour = Meilen pro Stunde
flight-spoken-meters-per-second = Meter pro Sekunde
flight-spoken-percent = Prozent
flight-spoken-link-lost = Link verloren
flight-spoken-gnss-lost = G N S S verloren
flight-spoken-control-weak = Steuerung schwach
flight-spoken-video-weak = Video schwach

## Instruments and markers

flight-instruments-obstacle = Hindernis
flight-instruments-none-near = keins nahe
flight-compass-north = N
flight-compass-east = O
flight-compass-south = S
flight-compass-west = W
flight-marker-hidden = { $distance }, verdeckt

## Messages over the flight

flight-message-task = Aufgabe { $task }: { $words }
flight-message-fly-to-path = Aufgabe { $task }: zur Bahn fliegen
flight-message-follow-path = Aufgabe { $task }: der Bahn folgen
flight-message-hold = Aufgabe { $task }: Position halten
flight-message-fly-home = Zurückfliegen: { $words }
flight-message-return = Zurück zu Aufgabe { $task }: { $words }
flight-message-first = Zuerst: { $words }
flight-detour-out-from-under = zuerst unter der Brücke herausfliegen
flight-detour-climb = zuerst steigen
flight-detour-descend = zuerst sinken
flight-detour-around = zuerst das Hindernis umfliegen
flight-message-session-over = Die Sitzung ist beendet
flight-message-lesson = Lektion: { $words }
flight-message-lesson-step = Lektion: { $step }/{ $steps } { $words }
flight-message-certified = Sitzung beendet: { $points } Punkte, zertifiziert
flight-message-not-certified = Sitzung beendet: { $points } Punkte, nicht zertifiziert
flight-message-nothing-to-score = Sitzung beendet: nichts zu bewerten
flight-message-way-up = { $way }, { $height } höher
flight-message-way-down = { $way }, { $height } tiefer
