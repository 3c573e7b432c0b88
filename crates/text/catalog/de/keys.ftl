## What the keys do, on the page of the keys

keys-forward = vorwärts fliegen
keys-back = rückwärts fliegen
keys-left = nach links fliegen
keys-right = nach rechts fliegen
keys-up = steigen
keys-down = sinken
keys-turn-left = nach links drehen
keys-turn-right = nach rechts drehen
keys-lamp = Scheinwerfer
keys-snapshot = fotografieren
keys-arm = Motoren starten
keys-disarm = Motoren abschalten
keys-take-off = starten
keys-land = landen
keys-return = zurückfliegen und landen
keys-hold = Position halten
keys-position = Positionsmodus
keys-gimbal-up = Kamera nach oben neigen
keys-gimbal-down = Kamera nach unten neigen
keys-camera-zoom-in = Kamera heranzoomen
keys-camera-zoom-out = Kamera herauszoomen
keys-freeze = einfrieren oder fortsetzen
keys-rewind = 10 s zurückspulen
keys-stick-response = nächste Knüppelreaktion
keys-swap = Ansichten wechseln
keys-map = Karte ein oder aus
keys-large-map = große Karte ein oder aus
keys-path = Bahn ein oder aus
keys-ghost = Geist ein oder aus
keys-walk = zum nächsten Standort gehen
keys-follow = Drohne folgen
keys-look-left = nach links sehen
keys-look-right = nach rechts sehen
keys-look-up = nach oben sehen
keys-look-down = nach unten sehen
keys-zoom-in = Ihre Ansicht vergrößern
keys-zoom-out = Ihre Ansicht verkleinern
keys-pause = Pause
keys-restart = Neustart
keys-sound = Ton ein oder aus

## The same in fewer words, beside the sticks on the page of the controller

keys-short-turn-left = links drehen
keys-short-turn-right = rechts drehen
keys-short-lamp = Scheinwerfer
keys-short-snapshot = Foto
keys-short-arm = Motoren an
keys-short-disarm = Motoren aus
keys-short-take-off = starten
keys-short-land = landen
keys-short-return = Rückkehr
keys-short-hold = halten
keys-short-position = Position
keys-short-gimbal-up = Gimbal hoch
keys-short-gimbal-down = Gimbal runter
keys-short-camera-zoom-in = Zoom größer
keys-short-camera-zoom-out = Zoom kleiner
keys-short-freeze = einfrieren
keys-short-rewind = zurückspulen
keys-short-stick-response = Knüppelreaktion
keys-short-walk = gehen

## Names of keys

keys-key-escape = Esc
keys-key-page-up = Bild auf
keys-key-page-down = Bild ab
keys-key-up = Auf
keys-key-down = Ab
keys-key-left = Links
keys-key-right = Rechts
keys-key-space = Leertaste
keys-key-enter = Enter
keys-key-tab = Tab
keys-key-backspace = Rücktaste
keys-allowed = ein Zeichen oder { $names }

## Messages to the pilot

keys-message-arm-first = Starten Sie zuerst die Motoren
keys-message-arm-first-key = Starten Sie zuerst die Motoren (Taste { $key })
keys-message = { $action }: { $result }
keys-message-no-vehicle = kein Fluggerät verbunden
keys-message-no-response = keine Antwort vom Fluggerät
keys-message-temporarily-rejected = vorübergehend abgelehnt
keys-message-denied = abgelehnt
keys-message-no-zoom = diese Kamera hat keinen Zoom
keys-message-unsupported = von diesem Fluggerät nicht unterstützt
keys-message-canceled = abgebrochen
keys-message-failed = fehlgeschlagen
keys-message-telemetry = Telemetrie von Scheinwerfer und Gimbal

## Calibration of a controller

keys-wizard-release = Lassen Sie beide Knüppel los (Gas ohne Feder in die Mitte), dann drücken Sie Enter.
keys-wizard-rest = Berühren Sie die Knüppel nicht ...
keys-wizard-range = Bewegen Sie beide Knüppel über den ganzen Weg, dann drücken Sie Enter. Gefundene Achsen: { $found } (nötig: mindestens { $needed }).
keys-wizard-center = Knüppel in die Mitte ...
keys-wizard-push-left-vertical = Drücken Sie den LINKEN Knüppel ganz nach OBEN und halten Sie ihn dort.
keys-wizard-push-left-horizontal = Drücken Sie den LINKEN Knüppel ganz nach RECHTS und halten Sie ihn dort.
keys-wizard-push-right-vertical = Drücken Sie den RECHTEN Knüppel ganz nach OBEN und halten Sie ihn dort.
keys-wizard-push-right-horizontal = Drücken Sie den RECHTEN Knüppel ganz nach RECHTS und halten Sie ihn dort.
keys-wizard-button-lamp = Drücken Sie den Knopf für den Scheinwerfer oder Enter zum Überspringen.
keys-wizard-button-snapshot = Drücken Sie den Knopf zum Fotografieren oder Enter zum Überspringen.
keys-wizard-button-arm = Drücken Sie den Knopf zum Starten der Motoren oder Enter zum Überspringen.
keys-wizard-button-take-off = Drücken Sie den Knopf für den Start oder Enter zum Überspringen.
keys-wizard-button-land = Drücken Sie den Knopf für die Landung oder Enter zum Überspringen.
keys-wizard-button-gimbal-up = Drücken Sie den Knopf für die Kamera nach oben oder Enter zum Überspringen.
keys-wizard-button-gimbal-down = Drücken Sie den Knopf für die Kamera nach unten oder Enter zum Überspringen.
keys-wizard-done = Fertig.
keys-wizard-note-button-taken = Dieser Knopf ist schon belegt.
keys-wizard-note-disconnected = Gerät getrennt. Verbinden Sie es wieder.
keys-wizard-note-few-axes = Weniger als vier Achsen bewegt.
keys-wizard-note-range = Diesen Knüppel haben Sie nicht über den ganzen Weg bewegt.
keys-wizard-note-axis-taken = Diese Achse ist schon belegt. Drücken Sie eine andere.
