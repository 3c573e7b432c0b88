## Page

report-title = Informe de la sesión: { $trainee }, { $started }
report-kicker = Informe de la sesión
report-sections = Secciones
report-print = Imprimir
report-section-better = Qué mejorar
report-section-scores = Puntuaciones
report-section-tasks = Tareas
report-section-next = Próximos pasos
report-section-flight = Vuelo
report-section-pictures = Fotos
report-section-defects = Defectos
report-section-feedback = Avisos
report-section-coverage = Cobertura
report-section-certification = Certificación
report-section-record = Datos

## Tables

report-table = Tabla: { $caption }
report-table-download = Descargar como CSV

## Words

report-contact-grave = persona o vehículo
report-control-pilot = piloto
report-control-mission = misión
report-control-script = script
report-control-autopilot = piloto automático
report-control-unknown = desconocido
report-between-tasks = entre tareas
report-on-path = en la trayectoria
report-off-path = fuera de la trayectoria
report-task = tarea { $task }
report-not-attempted = no iniciada
report-within-error = dentro del error
report-beyond-error = fuera del error
report-error-unknown = error desconocido
report-measure-certification-sum = suma de certificación
report-measure-flight-time = tiempo de vuelo
report-measure-crashes = colisiones
report-unit-points = puntos
report-measure-with-unit = { $measure } ({ $unit })
report-percent = { $value }%

## Column headings of several tables

report-column-task = tarea
report-column-name = nombre
report-column-state = estado
report-column-time = tiempo
report-column-time-s = tiempo (s)
report-column-with = con
report-column-path = trayectoria
report-column-path-flown = trayectoria recorrida (%)
report-column-on-path-share = porcentaje en la trayectoria (%)
report-column-speeding-loss = pérdida por exceso de velocidad
report-column-speed = velocidad (m/s)
report-column-distance = distancia (m)
report-column-clearance = separación (m)
report-column-battery = batería (%)
report-column-wind = viento (m/s)
report-column-wind-from = viento desde (grados)
report-column-number = número
report-column-place = lugar
report-column-added-air = diferencia con el viento libre (m/s)
report-column-added-updraft = componente ascendente (m/s)
report-column-east = este (m)
report-column-north = norte (m)
report-column-height = altura (m)
report-column-score = puntuación
report-column-points = puntos
report-column-frame = registro
report-column-element = elemento
report-column-condition-state = estado de condición
report-column-cause = causa
report-column-kind = tipo
report-column-found = encontrado
report-column-reason = motivo
report-column-scenario = escenario
report-column-flight-time = tiempo de vuelo
report-column-repetition = repetición
report-column-change = cambio
report-column-measurement-error = error de medición
report-column-minimal-change = cambio mínimo detectable
report-column-pixel-size = tamaño de píxel (mm)
report-column-angle = ángulo respecto a la normal (grados)
report-column-illuminance = iluminancia (lx)
report-column-blur = desenfoque por movimiento (px)

## Header

report-skip = Saltar a qué mejorar
report-level = nivel { $level } de { $levels }
report-flight-time = Tiempo de vuelo { $duration }, { $end }.
report-telemetry-covers = La telemetría cubre el { $share }% de la sesión.
report-practice-aids = Esta sesión fue { $aids }. Cuenta como práctica: no se certifica ni se compara con otras.
report-of-max = de { $max }
report-out-of-sight = Fuera de la vista del inspector durante { $total }; lo más largo, { $longest }, desde { $from }.
report-gnss-lost = Sin posición GNSS durante { $total }; lo más largo, { $longest }, desde { $from }.
report-position-error = El dron se equivocó en su posición hasta { $position } m (en { $at }) y en su altura hasta { $height } m (en { $height_at }).
report-heading-error = En su rumbo se equivocó hasta { $degrees }° (en { $at }).
report-video-poor = Enlace de vídeo deficiente durante { $total }; lo más largo, { $longest }, desde { $from }.
report-control-lost =
    { $count ->
        [one] Enlace de control perdido una vez.
       *[other] Enlace de control perdido { $count } veces.
    }
report-air-disturbed = En aire perturbado por un puente (al menos { $least } m/s de diferencia con el viento libre) durante { $total }; lo más largo, { $longest }, desde { $from }.
report-air-strongest = La perturbación fue máxima en { $at }, { $place }: { $speed } m/s de diferencia con el viento libre.
report-place-under = bajo el tablero del puente «{ $bridge }»
report-place-above = sobre el tablero del puente «{ $bridge }»
report-place-beside = junto al puente «{ $bridge }»
report-flow-lost = Sin flujo óptico sobre el agua durante { $total }; lo más largo, { $longest }, desde { $from }.
report-ranges-lost =
    { $count ->
        [one] El telémetro inferior falló en su única lectura sobre el agua.
       *[other] El telémetro inferior falló en { $lost } de { $count } lecturas sobre el agua.
    }
report-cold-battery = Batería fría ({ $temperature } °C): hasta { $missing } V menos que a 25 °C (en { $at }, con { $voltage } V restantes) y un { $share }% más de carga consumida.
report-walks = Recorridos del inspector: { $walks }.
report-walk = al punto { $place } desde { $moment }
report-walk-before = al punto { $place } antes del despegue

## Air around the bridges

report-air-title = Aire alrededor de los puentes
report-air-about = El flujo medio del aire en el modelo de viento del simulador, sin ráfagas. Los vórtices detrás de pilas y tableros están promediados y cuentan como turbulencia. Los colores y las flechas muestran la velocidad en el plano del dibujo.
report-air-wind = Alrededor del puente «{ $bridge }», el viento libre soplaba a { $speed } m/s desde { $from }° a 6 m de altura.
report-air-level = Puente «{ $bridge }» desde arriba, a { $height } m sobre el agua: altura mediana del vuelo en ese puente
report-air-across = Puente «{ $bridge }» en sección transversal, a { $station } m de su centro hacia { $toward }°, mirando hacia { $heading }°
report-air-places = Dónde los puentes perturbaron más el aire alrededor del dron (números en los dibujos):
report-air-off = { $speed } m/s de diferencia con el viento libre
report-air-caption = aire más perturbado

## Scores

report-scores-part = Las puntuaciones siguientes abarcan solo la parte volada.
report-scores-figure = Las cuatro puntuaciones: 0 en el centro, 100 en el borde
report-scores-radar = Gráfico radial de las cuatro puntuaciones
report-scores-caption = puntuaciones
report-column-raw = valor bruto
report-column-score-of-100 = puntuación (sobre 100)
report-explain-battery-failed = no aterrizó cerca del equipo de tierra antes de agotar la batería o el tiempo
report-explain-time = tiempo de vuelo { $time }; puntuación completa hasta { $best }
report-explain-no-contacts = sin contactos
report-explain-contacts =
    { $count ->
        [one] 1 contacto, 3 puntos perdidos
       *[other] { $count } contactos, 3 puntos perdidos por cada uno
    }
report-explain-grave = colisión con una persona o un vehículo: 0 puntos
report-explain-no-defects = este trabajo no tiene defectos
report-explain-defects =
    { $found } de { $placed ->
        [one] { $placed } defecto
       *[other] { $placed } defectos
    } { $found ->
        [one] encontrado
       *[other] encontrados
    }; { $hits } de { $taken ->
        [one] { $taken } foto
       *[other] { $taken } fotos
    } { $hits ->
        [one] mostró
       *[other] mostraron
    } un defecto nuevo
report-explain-no-tasks = este trabajo no tiene tareas
report-explain-none-attempted = ninguna tarea iniciada (la fórmula TASBID da 50 puntos)
report-explain-skipped =
    { $skipped } de { $tasks ->
        [one] { $tasks } tarea
       *[other] { $tasks } tareas
    } { $skipped ->
        [one] no iniciada
       *[other] no iniciadas
    }
report-explain-lowest = menor porcentaje en la trayectoria: { $share }% (tarea { $task }); exceso de velocidad durante { $speeding } s

## Do better

report-better-show = Mostrar { $moment }
report-better-picture = foto { $picture }
report-better-practice = practicar
report-better-next = Próximo vuelo:

## Next

report-next-note = Basado solo en esta sesión. El plan basado en todas las sesiones está en la página del alumno en el navegador.
report-next-consequence = Consecuencia: { $reason }
report-next-caption = escenarios recomendados
report-column-level = nivel
report-column-rule = regla
report-column-consequence-of = consecuencia de
report-column-measured = medido
report-column-limit = límite
report-column-urgency = urgencia

## Certification

report-certification-intro = El perfil de certificación agrega requisitos de aprobación (cumplido o no) que cierran vacíos de las cuatro puntuaciones TASBID. Sus propias puntuaciones tienen fórmulas distintas de las de TASBID y, por eso, otros nombres.
report-certification-passed = Se cumplen todos los requisitos.
report-certification-met = cumplido
report-certification-not-met = no cumplido
report-certification-unmet = No cumplidos: { $requirements }.
report-certification-exposure =
    A menos de { $limit } m de una superficie durante { $exposure } s; { $contacts ->
        [one] { $contacts } contacto
       *[other] { $contacts } contactos
    } ({ $merged } tras unir los separados por menos de un segundo); { $battery }% de batería al final; tiempo de vuelo { $time } (este trabajo necesita { $needed } con los defectos encontrados).
report-certification-too-fine =
    { $count ->
        [one] 1 defecto es demasiado fino para esta cámara y no cuenta para la exactitud de detección.
       *[other] { $count } defectos son demasiado finos para esta cámara y no cuentan para la exactitud de detección.
    }
report-certification-scores-caption = puntuaciones de certificación
report-certification-contacts-caption = contactos unidos
report-certification-pictures-caption = fotos según la calidad de imagen
report-certification-visits-caption = visitas a las tareas
report-certification-detection-caption = defectos encontrados por elemento, tipo y estado de condición
report-certification-hit = acierto
report-certification-no-hit = sin acierto
report-certification-not-counted = no cuenta
report-column-points-lost = puntos perdidos
report-column-result = resultado
report-column-new-defects = defectos nuevos
report-column-fails = por qué los defectos de la foto no contaron
report-column-visits = visitas
report-column-rms-distance = distancia RMS / umbral
report-column-rms-speed = velocidad RMS sobre el límite / límite
report-column-rms-framing = error RMS de encuadre (grados)
report-column-too-close-share = demasiado cerca (% del tiempo)
report-column-grouped-by = agrupado por
report-column-value = valor
report-column-placed = colocados

## Tasks

report-tasks-shares = Porcentaje del tiempo de cada tarea en la trayectoria y sobre el límite de velocidad
report-tasks-on-path = en la trayectoria
report-tasks-speeding = sobre el límite de velocidad
report-tasks-shares-title = Porcentaje en la trayectoria y exceso de velocidad por tarea
report-tasks-contacts = Contactos por tarea y objeto
report-tasks-no-contacts = Sin contactos.
report-tasks-contacts-title = Contactos por tarea y tipo
report-tasks-done = terminada
report-tasks-part = recorrida en parte
report-tasks-caption = tareas
report-tasks-contacts-caption = contactos
report-column-off-path-time = tiempo fuera de la trayectoria (s)
report-column-speeding-time = tiempo con exceso de velocidad (s)
report-column-mean-distance = distancia media (m)
report-column-max-distance = distancia máxima (m)
report-column-max-speed = velocidad máxima (m/s)
report-column-min-clearance = separación mínima (m)

## Defects

report-defects-none = Este trabajo no tiene defectos.
report-defects-count =
    { $found ->
        [one] Se encontró
       *[other] Se encontraron
    } { $found } de { $placed ->
        [one] { $placed } defecto
       *[other] { $placed } defectos
    }.
report-defects-found = encontrado
report-defects-missed = omitido
report-defects-missed-head = Defectos omitidos
report-defects-drawn = Cada dibujo muestra el defecto a 4 m, de frente y con el foco encendido.
report-defects-drawing = Defectos: { $title }
report-defects-side = Vista lateral del puente «{ $bridge }»
report-defects-top = Vista superior del puente «{ $bridge }»
report-defects-alt = Defecto { $defect }, visto a 4 m
report-defects-number = Defecto { $defect }
report-defects-kind = { $kind }, estado de condición { $state }
report-defects-place = En { $member } ({ $element }), { $size }.
report-defects-cause = Causa: { $cause }.
report-defects-size-line = { $length } cm de largo, { $width } mm de ancho
report-defects-size-area = { $length } por { $width } cm
report-defects-outcome = Resultado: { $outcome }.
report-defects-picture = foto { $picture }
report-defects-found-plain = encontrado
report-defects-found-by = encontrado en la foto { $picture }
report-defects-in-view = claramente visible durante { $seconds } s, primero a los { $moment }, pero sin fotografiar
report-defects-best-seen = mejor a la vista a los { $moment }, pero: { $reasons }
report-defects-never = siempre fuera de la vista de la cámara; el dron se acercó a { $distance } m a los { $moment }
report-defects-caption = defectos
report-column-defect = defecto
report-column-element-name = nombre del elemento
report-column-member = miembro
report-column-length-mm = longitud (mm)
report-column-width-mm = ancho (mm)
report-column-visible-time = tiempo claramente visible (s)
report-column-closest = distancia mínima (m)
report-column-outcome = resultado

## Pictures

report-pictures-none = No se tomaron fotos.
report-pictures-drawn = La sesión no contiene fotografías, por lo que cada vista se dibuja a partir de la geometría del puente. Solo cuentan los defectos dentro del marco discontinuo.
report-pictures-count =
    { $count ->
        [one] { $count } foto
       *[other] { $count } fotos
    }: { $verdicts }.
report-pictures-count-hit =
    { $count ->
        [one] { $count } acierto
       *[other] { $count } aciertos
    }
report-pictures-count-repeat =
    { $count ->
        [one] { $count } repetida
       *[other] { $count } repetidas
    }
report-pictures-count-too-dark =
    { $count ->
        [one] { $count } demasiado oscura
       *[other] { $count } demasiado oscuras
    }
report-pictures-count-too-far =
    { $count ->
        [one] { $count } demasiado lejana
       *[other] { $count } demasiado lejanas
    }
report-pictures-count-too-oblique =
    { $count ->
        [one] { $count } demasiado oblicua
       *[other] { $count } demasiado oblicuas
    }
report-pictures-count-false = { $count } sin defecto
report-verdict-hit = acierto
report-verdict-repeat = repetida
report-verdict-too-dark = demasiado oscura
report-verdict-too-far = demasiado lejana
report-verdict-too-oblique = demasiado oblicua
report-verdict-false = sin defecto
report-verdict-near = por poco
report-reason-first = muestra por primera vez: defecto { $defects }
report-reason-again = ya se había fotografiado: defecto { $defects }
report-reason-none = ningún defecto visible
report-reason-occluded = ningún defecto visible (el defecto { $defect } está oculto)
report-picture-number = Foto { $picture }
report-picture-at = a los { $moment }
report-picture-at-task = a los { $moment }, tarea { $task }
report-picture-alt = Foto { $picture }: { $reason }
report-picture-lamp-on = foco encendido
report-picture-lamp-off = foco apagado
report-picture-sky = Centro: cielo, { $lamp }
report-picture-center = Centro: { $name }, a { $distance } m, { $angle }° respecto a la normal de la superficie, { $pixel } mm por píxel, { $illuminance } lx ({ $lamp }), desenfoque por movimiento { $blur } px
report-pictures-sky = cielo
report-pictures-on = encendido
report-pictures-off = apagado
report-pictures-caption = fotos
report-column-picture = foto
report-column-verdict = veredicto
report-column-image-center = centro de la imagen
report-column-required-illuminance = iluminancia necesaria (lx)
report-column-lamp = foco

## Flight

report-chart-speed = Velocidad (m/s)
report-chart-distance = Distancia a la trayectoria de la tarea actual (m)
report-chart-clearance = Separación de la superficie más cercana (m)
report-chart-battery = Batería (%)
report-chart-wind = Viento horizontal en el dron (m/s)
report-chart-sticks = Posición de las palancas (recorrido completo = 1)
report-chart-label = { $title } a lo largo del tiempo; los valores están en la tabla siguiente
report-flight-timeline = Cronología de la sesión
report-flight-timeline-region = Cronología
report-flight-timeline-title = Fuente de control, tareas, avisos, fotos y cortes a lo largo del tiempo
report-flight-zoom = Arrastre sobre un gráfico para ampliarlo. Haga doble clic para restablecer la ampliación. Haga clic para mover el control deslizante.
report-flight-series = Descargar las series de tiempo como CSV
report-flight-export = Todos los fotogramas: { $link } en la página de la sesión en el navegador.
report-flight-marks = Marcas del instructor
report-flight-play = Reproducir
report-flight-pause = Pausa
report-flight-time-label = Tiempo
report-readout-task = Tarea
report-readout-path = Trayectoria
report-readout-distance = Distancia
report-readout-speed = Velocidad
report-readout-clearance = Separación
report-readout-battery = Batería
report-flight-color = Colorear la trayectoria de vuelo según
report-flight-video = Vista de la cámara
report-flight-video-missing = El video no se puede cargar desde aquí. También está en la página de la sesión y en la carpeta de la sesión ({ $file }).
report-flight-reference = trayectoria de referencia
report-flight-contact = contacto
report-flight-picture-hit = foto: acierto
report-flight-plan = Desde arriba, norte arriba
report-flight-plan-region = Planta
report-flight-south = Vista desde el sur
report-flight-elevation-region = Elevación
report-flight-side = Vista lateral del puente «{ $bridge }» con la trayectoria de vuelo cercana
report-flight-3d = Vista 3D
report-flight-rotate = Girar
report-flight-3d-region = Vista 3D del vuelo
report-flight-3d-note = Arrastre o use las teclas de flecha para girar. Use las teclas + y − o la rueda del ratón para ampliar o reducir.
report-flight-3d-label = Modelo 3D del sitio y de la trayectoria de vuelo. Las teclas de flecha lo giran; más y menos lo amplían y reducen.
report-flight-slider = { $moment }, tarea { $task }, { $path }
report-timeline-pilot = pilotado a mano
report-timeline-other = pilotado por misión, script o piloto automático
report-timeline-task = tarea
report-timeline-cue = aviso
report-timeline-gap = sin telemetría
report-timeline-flown-by = control
report-timeline-episode = { $cue } de { $from } a { $to }
report-timeline-picture = foto { $picture }: { $verdict }
report-timeline-pictures = fotos
report-timeline-note = nota: { $note }
report-timeline-notes = notas
report-timeline-mark = marca: { $mark }
report-timeline-marks = marcas
report-timeline-gaps = cortes
report-timeline-gap-for = sin telemetría durante { $seconds } s
report-timeline-gap-to-end = sin telemetría hasta el final
report-stick-turn-clockwise = giro horario
report-stick-turn = giro
report-flight-caption = datos de vuelo, con un dato cada pocos segundos

## Feedback

report-cue-crash = colisión
report-cue-too-close = muy cerca
report-cue-speeding = muy rápido
report-cue-stand-off = distancia
report-cue-off-path = desvío
report-cue-battery-yellow = bat. amarilla
report-cue-battery-red = bat. roja
report-feedback-none = No hubo avisos.
report-feedback-region = Resumen de los avisos
report-feedback-figure = Tiempo desde el aviso hasta el primer movimiento de las palancas; cada punto es un aviso; la barra marca la mediana
report-feedback-reactions-region = Tiempos de reacción
report-feedback-reactions = Tiempos de reacción por aviso
report-feedback-note = Una reacción es un movimiento de palanca de al menos el 10% del recorrido completo dentro de los 5 s posteriores al aviso. Si una palanca ya se movía, puede contar como reacción por casualidad.
report-feedback-answers = { $answers } de { $count }
report-feedback-caption = avisos mostrados
report-feedback-texts-caption = mensajes enviados
report-feedback-notes-caption = notas del instructor
report-feedback-before = antes del despegue
report-column-feedback = aviso
report-column-count = cantidad
report-column-total-duration = duración total (s)
report-column-stick-reactions = reacciones de palanca
report-column-median-reaction = mediana del tiempo de reacción (s)
report-column-duration = duración (s)
report-column-reaction-time = tiempo de reacción (s)
report-column-text = texto
report-column-note = nota

## Coverage

report-coverage-shown = bien captada
report-coverage-blurred = desenfocada
report-coverage-dark-on = demasiado oscura, foco encendido
report-coverage-dark-off = demasiado oscura, foco apagado
report-coverage-oblique = demasiado oblicua
report-coverage-far = demasiado lejos
report-coverage-unpictured = a la vista, sin fotografiar
report-coverage-unseen = nunca a la vista
report-coverage-none = Ninguna superficie del puente se puede inspeccionar desde las trayectorias de referencia; todas están fuera del alcance de la cámara.
report-coverage-summary = Las fotos captan bien el { $share } de la superficie inspeccionable del puente ({ $area } m² se pueden inspeccionar desde las trayectorias de referencia).
report-coverage-rest = El resto: { $reasons }.
report-coverage-reason = { $share }% { $outcome }
report-coverage-note = Una superficie es inspeccionable si se ve desde al menos un punto de una trayectoria de referencia a { $pixel } mm por píxel o menos (con esta resolución, una fisura de 1.27 mm, el límite entre los estados de condición 2 y 3, cubre medio píxel; esta cámara la alcanza desde hasta { $reach } m) y con un ángulo de { $angle }° como máximo respecto a la normal de la superficie. Está bien captada si una foto cumple ambos límites, tiene luz suficiente (incluida la del foco) para una exposición dentro de los límites de la cámara y tiene { $blur } px de desenfoque por movimiento como máximo. Si varias fotos muestran la misma parte de la superficie, cuenta la mejor.
report-coverage-figure = Cobertura de la superficie inspeccionable de cada elemento
report-coverage-bars = Cobertura de la superficie por elemento
report-coverage-bars-continued = Cobertura de la superficie por elemento, continuación
report-coverage-all = todos
report-coverage-caption = cobertura de la superficie; tamaño de píxel, ángulo, luz y desenfoque son promedios de las fotos que cumplen la resolución y el ángulo requeridos
report-column-inspectable = área inspeccionable (m²)
report-column-area = { $outcome } (m²)

## Record

report-record-frames-note = En los cortes de más de 1 s, los registros faltantes repiten la última posición conocida y se puntúan en ella.
report-record-files-note = Este informe se calcula a partir de la telemetría, el archivo de escenario y el archivo de la aeronave. Los mismos tres archivos producen siempre el mismo informe.
report-record-no-gaps = La telemetría no tiene cortes de más de 0.2 s.
report-record-gaps = Cortes de telemetría de más de 0.2 s: { $gaps }. Registros interpolados: { $interpolated }. Registros faltantes: { $missing }. La telemetría cubre el { $share }% de la sesión.
report-record-control-caption = fuente de control a lo largo del tiempo
report-record-caption = datos de la sesión
report-column-from = de
report-column-to = a
report-column-flown-by = control
report-column-item = dato
report-record-session = sesión
report-record-trainee = alumno
report-record-purpose = propósito
report-record-no-purpose = no especificado
report-record-started = inicio
report-record-scenario = escenario
report-record-scenario-hash = SHA-256 del escenario
report-record-aircraft = aeronave
report-record-aircraft-hash = SHA-256 de la aeronave
report-record-telemetry-hash = SHA-256 de la telemetría
report-record-seed = semilla
report-record-scorer = programa de puntuación
report-record-frames = registros puntuados
report-record-received = tramas MAVLink recibidas
report-record-lost = tramas perdidas
report-record-duplicate = tramas duplicadas
report-record-reordered = tramas fuera de orden

## Briefing

report-briefing-title = Instrucciones: { $title }
report-briefing-lead = Instrucciones para el trabajo { $job }
report-briefing-notes = De su instructor
report-briefing-pictures = Imágenes de su instructor
report-briefing-picture-missing = Falta la imagen { $file }.
report-briefing-site = Sitio
report-briefing-tasks = Tareas, en este orden
report-briefing-conditions = Condiciones
report-briefing-hazards = Peligros
report-briefing-counts = Qué cuenta
report-briefing-check = Revisión del sitio antes del despegue
report-briefing-above = Desde arriba, norte arriba
report-briefing-side = Puente «{ $bridge }» visto de lado
report-briefing-south = Desde el sur
report-briefing-task-region = Tareas
report-briefing-task = Tarea
report-briefing-where = Lugar
report-briefing-length = Longitud (m)
report-briefing-height = Altura sobre la plataforma de aterrizaje (m)
report-briefing-stand-off = Distancia a la superficie (m)
report-briefing-lamp = Foco
report-briefing-lamp-needed = necesario
report-briefing-heights = { $low } a { $high }

## Progress

report-progress-repetition = repetición { $repetition }
report-progress-scores = Las cuatro puntuaciones por repetición
report-progress-scores-title = Puntuaciones por repetición
report-progress-shares = Porcentaje en la trayectoria por tarea (%)
report-progress-shares-title = Porcentaje en la trayectoria por tarea y repetición
report-progress-crashes = Colisiones por objeto
report-progress-crashes-none = Ninguna.
report-progress-crashes-title = Colisiones por tipo y repetición
report-progress-curves = Curvas de aprendizaje
report-progress-curve = Curva de aprendizaje: { $score }
report-progress-curves-note = Cada curva es un ajuste de la ley potencial de la práctica a las repeticiones. El anillo marca la predicción para la siguiente repetición, que puede superar la puntuación máxima.
report-progress-curves-caption = curvas de aprendizaje (puntuación = primera puntuación × repetición ^ exponente)
report-progress-changes-caption = cambios desde la repetición anterior
report-progress-caption = puntuaciones, tiempo y colisiones por repetición
report-progress-on-path-caption = porcentaje en la trayectoria por tarea
report-progress-too-few = Una curva de aprendizaje requiere { $count } repeticiones del mismo trabajo.
report-column-repetitions = repeticiones
report-column-first = primera
report-column-exponent = exponente
report-column-next = siguiente
report-column-bridge-crashes = colisiones con el puente
report-column-ground-crashes = colisiones con el suelo
report-column-water-crashes = colisiones con el agua
report-column-other-crashes = otras colisiones
report-column-grave-crashes = colisiones con personas o vehículos

## Learning management system

report-scorm-result = { $points } de 100. { $verdict }
report-scorm-missing = No se encontró ningún sistema de gestión del aprendizaje.
report-scorm-sent = Resultado enviado al sistema de gestión del aprendizaje.
report-scorm-refused = El sistema de gestión del aprendizaje no aceptó el resultado.
