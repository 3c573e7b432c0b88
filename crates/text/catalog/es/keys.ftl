## What the keys do, on the page of the keys

keys-forward = volar adelante
keys-back = volar atrás
keys-left = volar a la izquierda
keys-right = volar a la derecha
keys-up = subir
keys-down = bajar
keys-turn-left = girar a la izquierda
keys-turn-right = girar a la derecha
keys-lamp = foco
keys-snapshot = fotografiar
keys-arm = armar motores
keys-disarm = desarmar motores
keys-take-off = despegar
keys-land = aterrizar
keys-return = regresar y aterrizar
keys-hold = mantener la posición
keys-position = modo de posición
keys-gimbal-up = cámara hacia arriba
keys-gimbal-down = cámara hacia abajo
keys-camera-zoom-in = acercar la cámara
keys-camera-zoom-out = alejar la cámara
keys-freeze = congelar o continuar
keys-rewind = rebobinar 10 s
keys-stick-response = siguiente respuesta a las palancas
keys-swap = cambiar las vistas
keys-map = mapa sí/no
keys-large-map = mapa grande sí/no
keys-path = trayectoria sí/no
keys-ghost = fantasma sí/no
keys-walk = caminar al siguiente punto
keys-follow = seguir al dron
keys-look-left = mirar a la izquierda
keys-look-right = mirar a la derecha
keys-look-up = mirar arriba
keys-look-down = mirar abajo
keys-zoom-in = acercar su vista
keys-zoom-out = alejar su vista
keys-pause = pausa
keys-restart = reiniciar
keys-sound = sonido sí/no

## The same in fewer words, beside the sticks on the page of the controller

keys-short-turn-left = girar izq.
keys-short-turn-right = girar der.
keys-short-lamp = foco
keys-short-snapshot = foto
keys-short-arm = armar
keys-short-disarm = desarmar
keys-short-take-off = despegar
keys-short-land = aterrizar
keys-short-return = regresar
keys-short-hold = mantener
keys-short-position = posición
keys-short-gimbal-up = gimbal arriba
keys-short-gimbal-down = gimbal abajo
keys-short-camera-zoom-in = acercar zoom
keys-short-camera-zoom-out = alejar zoom
keys-short-freeze = congelar
keys-short-rewind = rebobinar
keys-short-stick-response = respuesta a las palancas
keys-short-walk = caminar

## Names of keys

keys-key-escape = Esc
keys-key-page-up = Re Pág
keys-key-page-down = Av Pág
keys-key-up = Arriba
keys-key-down = Abajo
keys-key-left = Izquierda
keys-key-right = Derecha
keys-key-space = Espacio
keys-key-enter = Enter
keys-key-tab = Tab
keys-key-backspace = Retroceso
keys-allowed = un carácter, o { $names }

## Messages to the pilot

keys-message-arm-first = Arme primero los motores
keys-message-arm-first-key = Arme primero los motores (tecla { $key })
keys-message = { $action }: { $result }
keys-message-no-vehicle = ningún vehículo conectado
keys-message-no-response = el vehículo no responde
keys-message-temporarily-rejected = rechazado temporalmente
keys-message-denied = denegado
keys-message-no-zoom = esta cámara no tiene zoom
keys-message-unsupported = no admitido por este vehículo
keys-message-canceled = cancelado
keys-message-failed = falló
keys-message-telemetry = telemetría del foco y del gimbal

## Calibration of a controller

keys-wizard-release = Suelte ambas palancas (centre el acelerador si no tiene resorte) y pulse Enter.
keys-wizard-rest = No toque las palancas ...
keys-wizard-range = Mueva ambas palancas por todo su recorrido y pulse Enter. Ejes encontrados: { $found } (se necesitan al menos { $needed }).
keys-wizard-center = Centre las palancas ...
keys-wizard-push-left-vertical = Empuje la palanca IZQUIERDA totalmente hacia ARRIBA y manténgala ahí.
keys-wizard-push-left-horizontal = Empuje la palanca IZQUIERDA totalmente a la DERECHA y manténgala ahí.
keys-wizard-push-right-vertical = Empuje la palanca DERECHA totalmente hacia ARRIBA y manténgala ahí.
keys-wizard-push-right-horizontal = Empuje la palanca DERECHA totalmente a la DERECHA y manténgala ahí.
keys-wizard-button-lamp = Pulse el botón del foco, o Enter para omitirlo.
keys-wizard-button-snapshot = Pulse el botón de la foto, o Enter para omitirlo.
keys-wizard-button-arm = Pulse el botón para armar, o Enter para omitirlo.
keys-wizard-button-take-off = Pulse el botón de despegue, o Enter para omitirlo.
keys-wizard-button-land = Pulse el botón de aterrizaje, o Enter para omitirlo.
keys-wizard-button-gimbal-up = Pulse el botón de cámara arriba, o Enter para omitirlo.
keys-wizard-button-gimbal-down = Pulse el botón de cámara abajo, o Enter para omitirlo.
keys-wizard-done = Listo.
keys-wizard-note-button-taken = Ese botón ya está asignado.
keys-wizard-note-disconnected = Dispositivo desconectado. Conéctelo de nuevo.
keys-wizard-note-few-axes = Se movieron menos de cuatro ejes.
keys-wizard-note-range = No movió esa palanca por todo su recorrido.
keys-wizard-note-axis-taken = Ese eje ya está asignado. Empuje otro.
