## Speed, battery, readouts

flight-speed-limit = límite { $limit }
flight-battery-no-data = sin datos de batería
flight-battery-unknown = batería ?
flight-readout-height = altura
flight-readout-home = base
flight-readout-gimbal = gimbal
flight-readout-time-left = t. restante
flight-readout-lamp = foco
flight-readout-lamp-on = encendido
flight-readout-lamp-off = apagado
flight-readout-pictures = fotos
flight-readout-zoom = zoom

## Status

flight-status-no-mode = sin modo
flight-status-gnss-count = GNSS { $count }
flight-status-gnss-ok = GNSS ok
flight-status-gnss-lost-count = GNSS perdido ({ $count })
flight-status-gnss-lost = GNSS perdido
flight-status-gnss-unknown = GNSS ?
flight-status-link-ok = enlace ok
flight-status-link-lost = SIN ENLACE { $age }
flight-status-frozen = CONGELADO
flight-status-signal-control = control
flight-status-signal-video = vídeo
flight-status-control-weak = CONTROL DÉBIL
flight-status-video-weak = VÍDEO DÉBIL

## The next step of the job

flight-step-take-off = Despegue
flight-step-return-to-task = Fuera de la trayectoria: vuelva a la tarea { $task } de { $tasks }
flight-step-fly-to-task = Vuele a la tarea { $task } de { $tasks }
flight-step-fly-to = Vuele a la tarea
flight-step-inspect-task = Inspeccione la tarea { $task } de { $tasks }
flight-step-inspect = Inspeccione
flight-step-fly-home = Regrese a la base
flight-step-land = Aterrice en la plataforma
flight-step-over = Sesión terminada
flight-step-hold-task = Mantenga la posición: tarea { $task } de { $tasks }
flight-step-hold = Mantenga la posición
flight-way-ahead = { $distance }, al frente
flight-way-behind = { $distance }, detrás de usted
flight-way-left = { $distance }, { $angle } a la izquierda
flight-way-right = { $distance }, { $angle } a la derecha
flight-panel-height = altura
flight-panel-path = trayectoria
flight-panel-stand-off = distancia
flight-panel-time = tiempo
flight-panel-time-of = { $flown } de { $needed }
flight-height-level = misma altura
flight-height-up = subir { $height }
flight-height-down = bajar { $height }
flight-deviation-above = { $distance }, { $height } arriba
flight-deviation-below = { $distance }, { $height } abajo

## Lessons

flight-lesson-complete = Lección completada
flight-lesson-step = Paso { $step } de { $steps }
flight-lesson-arm = Arme los motores
flight-lesson-take-off = Despegue hasta { $height }
flight-lesson-hover = Permanezca { $time } en el anillo
flight-lesson-turn = Gire { $angle }
flight-lesson-fly-path = Siga la trayectoria
flight-lesson-stop-at = Deténgase { $time } en el anillo
flight-lesson-tilt-down = Incline la cámara { $angle } hacia abajo
flight-lesson-tilt-up = Incline la cámara { $angle } hacia arriba
flight-lesson-lamp = Encienda el foco
flight-lesson-photograph = Fotografíe un defecto
flight-lesson-fly-home = Regrese a la plataforma
flight-lesson-land = Aterrice en la plataforma
flight-lesson-done = Todos los pasos completados
flight-how-arm = Pulse { $arm }. Las hélices empiezan a girar.
flight-how-take-off = Pulse { $take_off } o mantenga { $up } para subir.
flight-how-hover = Vaya allí con { $forward } { $left } { $back } { $right }, { $up } y { $down }; luego suelte todas las teclas.
flight-how-turn = Mantenga { $turn_left } o { $turn_right }.
flight-how-fly-path = Siga la cinta por las puertas: { $forward } { $left } { $back } { $right }, { $up } y { $down }.
flight-how-stop-at = Suelte las teclas a tiempo: el dron necesita espacio para frenar.
flight-how-tilt-camera = Pulse varias veces { $gimbal_up } (arriba) o { $gimbal_down } (abajo).
flight-how-lamp = Pulse { $lamp }.
flight-how-photograph = Lleve el defecto entre las marcas de las esquinas y pulse { $snapshot }.
flight-how-fly-home = El cuadrado blanco de la brújula indica el camino.
flight-how-land = Pulse { $land } sobre la plataforma o mantenga { $down } hasta que paren los motores.
flight-how-start = Pulse { $arm } para armar los motores y luego { $take_off }.
flight-how-done = Ya puede volar el primer ejercicio.
flight-remark-motors-off = los motores están apagados: ármelos de nuevo
flight-remark-left-ring = salió del anillo: permanezca { $time }
flight-remark-no-defect = no hay ningún defecto en la foto

## Warnings

flight-cue-crash = Colisión
flight-cue-too-close = Muy cerca
flight-cue-speeding = Muy rápido
flight-cue-stand-off = Distancia
flight-cue-off-path = Desvío
flight-cue-battery = Batería
flight-warning-crash = { $name }: { $object }
flight-warning-too-close = { $name }: { $distance }, límite { $limit }
flight-warning-speeding = { $name }: { $speed }, límite { $limit }
flight-warning-stand-off-small = { $name } muy corta: { $distance }, recomendada { $recommended }
flight-warning-stand-off-large = { $name } muy larga: { $distance }, recomendada { $recommended }
flight-warning-off-path = { $name } { $distance }: { $direction }
flight-warning-battery = { $name } { $level }
flight-directions-two = { $first } { $second ->
        [izquierda] e
       *[other] y
    } { $second }
flight-directions-three = { $first }, { $second } y { $third }
flight-object-member = elemento { $name }
flight-object-pad = plataforma
flight-object-inspector = inspector
flight-object-crew-truck = camioneta
flight-object-car = auto { $number }
flight-object-truck = camión { $number }
flight-object-pedestrian = peatón { $number }
flight-spoken-meters = metros
flight-spoken-feet = pies
flight-spoken-miles-per-hour = millas por hora
flight-spoken-meters-per-second = metros por segundo
flight-spoken-percent = por ciento
flight-spoken-link-lost = Enlace perdido
flight-spoken-gnss-lost = G N S S perdido
flight-spoken-control-weak = Enlace de control débil
flight-spoken-video-weak = Enlace de vídeo débil

## Instruments and markers

flight-instruments-obstacle = obstáculo
flight-instruments-none-near = ninguno
flight-compass-north = N
flight-compass-east = E
flight-compass-south = S
flight-compass-west = O
flight-marker-hidden = { $distance }, oculto

## Messages over the flight

flight-message-task = Tarea { $task }: { $words }
flight-message-fly-to-path = Tarea { $task }: vuele a la trayectoria
flight-message-follow-path = Tarea { $task }: siga la trayectoria
flight-message-hold = Tarea { $task }: mantenga la posición
flight-message-fly-home = Regrese a la base: { $words }
flight-message-return = Vuelva a la tarea { $task }: { $words }
flight-message-first = Primero: { $words }
flight-detour-out-from-under = primero salga de debajo del puente
flight-detour-climb = primero ascienda
flight-detour-descend = primero descienda
flight-detour-around = primero rodee el obstáculo
flight-message-session-over = La sesión terminó
flight-message-lesson = Lección: { $words }
flight-message-lesson-step = Lección: { $step }/{ $steps } { $words }
flight-message-certified = Sesión terminada: { $points } puntos, certificado
flight-message-not-certified = Sesión terminada: { $points } puntos, no certificado
flight-message-nothing-to-score = Sesión terminada: nada que puntuar
flight-message-way-up = { $way }, { $height } arriba
flight-message-way-down = { $way }, { $height } abajo
