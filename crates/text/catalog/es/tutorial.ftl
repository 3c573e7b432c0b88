tutorial-title = Tutorial { $page } de { $pages }: { $title }
tutorial-next = Página siguiente
tutorial-fly = Volar
tutorial-done = Listo
tutorial-skip = Omitir
tutorial-skip-and-fly = Omitir y volar

## The job

tutorial-job-title = el trabajo
tutorial-job-text =
    Usted está en una ladera con un dron. Siga la trayectoria de cada tarea, fotografíe cada defecto una vez, regrese y aterrice en la plataforma.

    La línea naranja muestra un vuelo de ejemplo; los puntos rojos marcan sus fotos.
tutorial-job-pad = despegue y aterrizaje
tutorial-job-suspension = puente colgante
tutorial-job-arch = puente de arco
tutorial-job-task = tarea 4: rodear la pila

## Two views

tutorial-views-title = dos vistas
tutorial-views-text =
    Su propia vista desde el suelo y la vista de la cámara del dron, que es la más grande.

    Pulse { $swap } para cambiar la disposición. Arrastre con el ratón para mirar alrededor y use la rueda para el zoom. Pulse { $follow } para que su vista siga otra vez al dron.
tutorial-views-own = su propia vista
tutorial-views-navigation = navegación
tutorial-views-camera = vista de la cámara
tutorial-views-note = El marco en su vista señala el dron y muestra su distancia. En la práctica, bajo la navegación aparecen un mapa y un perfil lateral del puente.

## The display

tutorial-display-title = la pantalla
tutorial-display-text =
    Durante una tarea, no supere el límite de velocidad. El símbolo de la batería pasa de verde a amarillo (triángulo) y a rojo (octágono intermitente): regrese antes de que se agote.

    Una evaluación no tiene mapa.
tutorial-display-speed = velocidad y límite
tutorial-display-status = modo, satélites, enlace
tutorial-display-battery = batería
tutorial-display-readouts = altura, distancia, tiempo
tutorial-display-corners = defectos dentro de estas esquinas

## Warnings

tutorial-warnings-title = avisos
tutorial-warnings-text =
    Los avisos aparecen abajo a la izquierda, el más grave al final. Cada uno tiene su forma y, con el sonido activado, su tono.

    Disco azul: vuelva a la trayectoria.
    Triángulo amarillo: reduzca la velocidad.
    Rombo naranja: aléjese de la estructura.
    Octágono rojo: chocó con algo.
tutorial-warnings-warnings = avisos
tutorial-warnings-battery = batería baja
tutorial-warnings-object = pila

## Defects

tutorial-defects-title = defectos
tutorial-defects-text =
    Los mismos defectos a 1 m, 3 m, 8 m con una lente. Una foto cuenta si el defecto está entre las marcas de las esquinas, iluminado, no se ve de canto y, si es una fisura, mide al menos medio píxel de ancho. Acérquese, o use el zoom ({ $camera_zoom_in }) si la cámara lo tiene.

    Manchas, marcas de encofrado, fisuras selladas, telarañas y grafitis no son defectos. Cada foto sin un defecto nuevo baja su exactitud.
tutorial-defects-crack = fisura
tutorial-defects-spall = descascaramiento
tutorial-defects-efflorescence = eflorescencia
tutorial-defects-corrosion = corrosión

## Light and scores

tutorial-light-title = luz y puntuación
tutorial-light-text =
    Use el foco ({ $lamp }) en lugares oscuros, como muestran estas fotos.

    Conformidad: siga la trayectoria bajo el límite de velocidad. Eficiencia: regrese antes de 15 minutos. Seguridad: no toque nada; chocar con una persona o un vehículo termina la sesión. Exactitud: fotografíe cada defecto una vez.
tutorial-light-without = sin foco
tutorial-light-with = con foco
tutorial-light-closer = acérquese para verlo
tutorial-light-keys = Suelte las palancas para quedarse quieto. Teclas: { $arm } armar, { $take_off } despegar, { $up } { $down } subir y bajar, { $turn_left } { $turn_right } girar, { $forward } { $back } { $left } { $right } volar, { $lamp } foco, { $snapshot } fotografiar, { $gimbal_up } { $gimbal_down } inclinar la cámara, { $land } aterrizar, { $pause } pausa.
