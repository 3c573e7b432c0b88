live-title = Vuelo en vivo
live-waiting = En espera de un vuelo en { $address }. Esta página se actualizará cuando comience uno.
live-no-vehicle = No hay ningún vehículo configurado. Inicie el servidor con { $command }.
live-not-connected = Sin conexión
live-now = Ahora
live-task = Tarea
live-step = Siguiente paso
live-progress = Trayectoria recorrida
live-time = Tiempo
live-speed = Velocidad
live-height = Altura
live-clearance = Separación
live-battery = Batería
live-contact = Contacto
live-traffic = Tráfico
live-wind = Viento en el dron
live-wind-now = { $speed } m/s desde { $direction }°
live-wind-calm = { $speed } m/s
live-gnss = GNSS
live-gnss-now =
    { $satellites ->
        [one] { $satellites } satélite
       *[other] { $satellites } satélites
    }
live-gnss-dilution =
    { $satellites ->
        [one] { $satellites } satélite
       *[other] { $satellites } satélites
    }, HDOP { $dilution }
live-gnss-lost =
    Sin posición, { $satellites ->
        [one] { $satellites } satélite
       *[other] { $satellites } satélites
    }
live-compass = Brújula
live-compass-now = desviada { $degrees }°
live-radio = Margen de radio
live-radio-now = control { $control } dB, vídeo { $video } dB
live-hazards = Peligros activos
live-warning-control = Enlace de control débil
live-warning-gnss = GNSS perdido
live-warning-video = Vídeo deficiente
live-warning-compass = Brújula perturbada
live-cues = Avisos activos
live-site = Sitio
live-view-above = Desde arriba, con el norte arriba
live-view-side = { $bridge } desde un lado
live-view-south = Desde el sur
live-camera-caption = Vista de la cámara, actualizada aproximadamente una vez por segundo
live-camera = Vista actual de la cámara
live-actions = Acciones del instructor
live-log = Registro de mensajes
live-log-label = Mensajes del vehículo y del monitor, los más recientes primero
live-vehicles = Vehículos
live-all-flights = Todos los vuelos
live-vehicle-at = Vehículo { $number } · { $address }
live-note = Nota para el informe
live-add-note = Agregar nota
live-wind-speed = Velocidad del viento (m/s)
live-wind-from = Dirección del viento (grados)
live-set-wind = Ajustar el viento
live-traffic-note = Al cerrar un puente, no entra más tráfico; los vehículos que ya están en él salen.
live-close-bridges = Cerrar los puentes
live-open-bridges = Abrir los puentes
live-practice-note = Solo en práctica. Un vuelo que se congeló, se rebobinó o se llevó a otro lugar no se certifica ni se compara con otros.
live-freeze = Congelar
live-continue = Continuar
live-rewind = Rebobinar 10 s
live-move = Llevar al inicio de esta tarea
live-place = Punto
live-walk = Enviar al inspector a este punto
live-component = Componente
live-unit-gnss = Navegación por satélite
live-unit-compass = Brújula
live-unit-barometer = Barómetro
live-unit-battery = Batería
live-inject = Provocar falla
live-clear = Quitar falla

live-state-frozen = congelado
live-state-armed = en vivo, motores armados
live-state-disarmed = en vivo, motores desarmados
live-state-silent = sin telemetría
live-off-path = fuera de la trayectoria
live-traffic-open = abierto
live-traffic-closed = cerrado
live-message-picture = foto { $number }
live-failed-status = Falló: estado HTTP { $status }
live-failed-login = Falló: inicie sesión
live-failed-silent = Falló: el servidor no responde

# Commands of the instructor in the message log, and why the vehicle rejects them.
live-report-note = nota: { $note }
live-report-wind = instructor: viento de { $speed } m/s desde { $from }°
live-report-bridges-open = instructor: puentes abiertos al tráfico
live-report-bridges-closed = instructor: puentes cerrados al tráfico
live-report-freeze = instructor: congelar
live-report-continue = instructor: continuar
live-report-rewind = instructor: rebobinar { $seconds } s
live-report-move = instructor: llevar a la tarea { $task }
live-report-walk = instructor: el inspector camina al punto { $place }
live-report-fails = instructor: falla de { $unit }
live-report-restored = instructor: { $unit } en funcionamiento de nuevo
live-report-no-response = { $command }: sin respuesta
live-report-rejected = { $command }: rechazado, { $reason }
live-rejected-not-now = no es posible ahora
live-rejected-unsupported = el vehículo no admite esta orden
live-rejected-denied = el vehículo denegó esta orden
live-rejected-failed = el vehículo informó de un fallo
live-rejected-no-such-parameter = este vehículo no tiene ese parámetro
live-rejected-out-of-range = el valor está fuera del intervalo permitido
live-rejected-read-only = el parámetro es de solo lectura
live-rejected-invalid-value = el vehículo rechazó el valor

live-own-title = Mi vuelo
live-own-none = No hay ningún vuelo en curso. Esta página se actualizará cuando comience su vuelo.
live-own-window = Vuelo en curso. La imagen de la cámara está disponible solo en la ventana del simulador.
live-own-flying = Vuelo en curso.
live-own-status = Sin conexión: estado HTTP { $status }
live-own-login = Sin conexión: inicie sesión
live-own-caption = La vista de su cámara, actualizada aproximadamente una vez por segundo
live-own-camera = La vista actual de su cámara

live-tiles-title = Vuelos en vivo
live-tiles-no-vehicle = No hay ningún vehículo configurado. Inicie el servidor con { $command }, una vez por cada vuelo.
live-tile-vehicle = Vehículo { $number }
live-tile-waiting = En espera de un vuelo en { $address }
live-tile-camera = Vista de la cámara del vehículo { $number }
live-tile-cue = Último aviso:
live-tile-no-cue = ninguno aún
live-tile-hazards = Peligros:
live-tile-no-hazard = ninguno
live-tile-status = estado HTTP { $status }
live-tile-login = inicie sesión
live-tile-not-connected = sin conexión

live-error-no-vehicle = No hay ningún vehículo configurado (--vehicle).
