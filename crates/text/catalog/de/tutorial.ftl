tutorial-title = Einführung { $page } von { $pages }: { $title }
tutorial-next = Nächste Seite
tutorial-fly = Fliegen
tutorial-done = Fertig
tutorial-skip = Überspringen
tutorial-skip-and-fly = Überspringen und fliegen

## The job

tutorial-job-title = der Auftrag
tutorial-job-text =
    Sie stehen mit einer Drohne an einem Hang. Folgen Sie der Bahn jeder Aufgabe, fotografieren Sie jeden Schaden einmal, kehren Sie dann zurück und landen Sie auf dem Landeplatz.

    Die orange Linie zeigt einen Beispielflug, die roten Punkte seine Bilder.
tutorial-job-pad = hier starten und landen
tutorial-job-suspension = Hängebrücke
tutorial-job-arch = Bogenbrücke
tutorial-job-task = Aufgabe 4: um den Pfeiler

## Two views

tutorial-views-title = zwei Ansichten
tutorial-views-text =
    Ihre eigene Sicht vom Boden und die größere Ansicht der Drohnenkamera.

    Drücken Sie { $swap }, um die Anordnung zu wechseln. Ziehen Sie mit der Maus, um sich umzusehen, und zoomen Sie mit dem Rad. Mit { $follow } folgt Ihre Sicht wieder der Drohne.
tutorial-views-own = Ihre eigene Sicht
tutorial-views-navigation = Navigationsanzeige
tutorial-views-camera = Kamerabild
tutorial-views-note = Der Rahmen in Ihrer Sicht markiert die Drohne und zeigt ihre Entfernung. Im Übungsflug stehen unter der Navigationsanzeige eine Karte und ein Seitenprofil der Brücke.

## The display

tutorial-display-title = die Anzeige
tutorial-display-text =
    Bleiben Sie in einer Aufgabe unter dem Tempolimit. Das Akkusymbol wechselt von Grün über Gelb (Dreieck) zu Rot (blinkendes Achteck): Kehren Sie zurück, bevor der Akku leer ist.

    Ein Bewertungsflug hat keine Karte.
tutorial-display-speed = Tempo und Limit
tutorial-display-status = Modus, Satelliten, Link
tutorial-display-battery = Akku
tutorial-display-readouts = Höhe, Entfernung, Restzeit
tutorial-display-corners = Schäden innerhalb dieser Ecken

## Warnings

tutorial-warnings-title = Warnungen
tutorial-warnings-text =
    Warnungen erscheinen links unten, die ernsteste zuunterst. Jede hat ihre eigene Form und bei eingeschaltetem Ton ihren eigenen Klang.

    Blaue Scheibe: zurück zur Bahn.
    Gelbes Dreieck: langsamer.
    Orange Raute: weg vom Bauwerk.
    Rotes Achteck: Sie haben etwas getroffen.
tutorial-warnings-warnings = Warnungen
tutorial-warnings-battery = Akku schwach
tutorial-warnings-object = Pfeiler

## Defects

tutorial-defects-title = Schäden
tutorial-defects-text =
    Dieselben Schäden aus 1 m, 3 m, 8 m mit einem Objektiv. Ein Bild zählt, wenn der Schaden innerhalb der Eckmarken liegt, beleuchtet ist, nicht zu schräg gesehen wird und ein Riss mindestens ein halbes Pixel breit ist. Fliegen Sie näher heran, oder zoomen Sie ({ $camera_zoom_in }), falls die Kamera das kann.

    Flecken, Schalungsfugen, verpresste Risse, Spinnweben und Graffiti sind keine Schäden. Jedes Bild ohne neuen Schaden senkt Ihre Genauigkeit.
tutorial-defects-crack = Riss
tutorial-defects-spall = Abplatzung
tutorial-defects-efflorescence = Aussinterung
tutorial-defects-corrosion = Korrosion

## Light and scores

tutorial-light-title = Licht und Wertung
tutorial-light-text =
    Benutzen Sie an dunklen Stellen den Scheinwerfer ({ $lamp }), wie diese Bilder zeigen.

    Bahntreue: auf der Bahn und unter dem Tempolimit bleiben. Effizienz: innerhalb von 15 Minuten zurückkehren. Sicherheit: nichts berühren; eine Kollision mit Personen oder Fahrzeugen beendet die Sitzung. Genauigkeit: jeden Schaden einmal fotografieren.
tutorial-light-without = ohne Scheinwerfer
tutorial-light-with = mit Scheinwerfer
tutorial-light-closer = zum Prüfen näher heran
tutorial-light-keys = Loslassen heißt schweben. Tasten: { $arm } Motoren starten, { $take_off } starten, { $up } { $down } hoch und runter, { $turn_left } { $turn_right } drehen, { $forward } { $back } { $left } { $right } fliegen, { $lamp } Scheinwerfer, { $snapshot } fotografieren, { $gimbal_up } { $gimbal_down } Kamera neigen, { $land } landen, { $pause } Pause.
