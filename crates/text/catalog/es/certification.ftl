certification-tasks-done = tareas terminadas
certification-landed-at-home = aterrizaje en la base
certification-person-or-vehicle-hits = colisiones con personas o vehículos
certification-battery = batería al aterrizar
certification-contacts = contactos
certification-contact-speed = contacto más rápido
certification-conformity = conformidad ponderada por cobertura
certification-precision = precisión de vuelo
certification-safety = seguridad ponderada por impacto
certification-accuracy = exactitud de detección
certification-efficiency = eficiencia de tiempo
certification-practice-aids = veces que se congeló o rebobinó

certification-explain-tasks-done = Cada tarea cuenta como terminada cuando se ha recorrido una parte suficiente de su trayectoria.
certification-explain-landed-at-home = La sesión debe terminar con un aterrizaje cerca del equipo de tierra.
certification-explain-person-or-vehicle-hits = Personas y vehículos, también estacionados, que tocó el dron.
certification-explain-battery = La carga que queda después del aterrizaje.
certification-explain-contacts = Cuántas veces tocó el dron el puente, el suelo o el agua; los contactos separados por menos de un segundo cuentan una vez.
certification-explain-contact-speed = La velocidad más alta con la que el dron tocó algo.
certification-explain-conformity = El tiempo sobre la trayectoria dentro del límite de velocidad, ponderado por la parte recorrida de cada trayectoria. La puntuación TASBID de conformidad no tiene en cuenta las partes omitidas.
certification-explain-precision = Lo pequeños que fueron durante las tareas los errores de distancia a la trayectoria, velocidad, dirección de la cámara y distancia a las superficies.
certification-explain-safety = 100 puntos menos lo perdido por cada contacto, que aumenta con su velocidad, y por el tiempo demasiado cerca de una superficie; 0 si hubo una colisión con una persona o un vehículo.
certification-explain-accuracy = La proporción de defectos hallados y la de fotos que muestran alguno, combinadas. A diferencia de la puntuación TASBID de exactitud, solo cuentan las fotos con suficiente detalle y poco desenfoque.
certification-explain-efficiency = El tiempo de vuelo comparado con el tiempo que necesita este trabajo con los defectos encontrados.
certification-explain-practice-aids = Congelar y rebobinar son ayudas de práctica; un vuelo certificado no las usa.

certification-at-least = al menos { $limit }
certification-at-most = como máximo { $limit }
certification-points = { $value } puntos
certification-yes = sí
certification-no = no
certification-does-not-apply = no se aplica
certification-no-evidence = sin datos

certification-unmet-practice = sesión { $aids }, por lo que fue una práctica
certification-unmet-hit = colisión con una persona o un vehículo
certification-unmet-task-part = tarea { $task } no terminada: { $share }% de su trayectoria, se requiere { $needed }%
certification-unmet-task-not-attempted = tarea { $task } no iniciada
certification-unmet-landing = no se aterrizó en la base
certification-unmet-battery = { $battery } de batería al aterrizar, se requiere { $needed }%
certification-unmet-one-contact = 1 contacto, se permiten como máximo { $limit }
certification-unmet-contacts = { $contacts } contactos, se permiten como máximo { $limit }
certification-unmet-contact-speed = contacto a { $speed }, se permite como máximo { $limit }
certification-unmet-score = { $score } { $value }, se requiere { $needed }
certification-unmet-no-evidence = sin datos para: { $score }

certification-picture-resolution = resolución { $value } mm/px, límite { $limit } mm/px
certification-picture-motion-blur = desenfoque por movimiento { $value } px, límite { $limit } px
certification-picture-incidence = incidencia { $value }°, límite { $limit }°
certification-picture-too-fine = demasiado fino para esta cámara

certification-job-tasks = cada tarea recorrida en al menos { $share }% de su trayectoria
certification-job-landing = aterrizaje en la base con al menos { $battery }% de batería, sin colisiones con personas ni vehículos
certification-job-aids = sin congelar ni rebobinar, que son ayudas de práctica
certification-job-contacts =
    { $contacts ->
        [one] como máximo { $contacts } contacto, no
       *[other] como máximo { $contacts } contactos, ninguno
    } a más de { $speed } m/s
certification-job-scores = conformidad ponderada por cobertura de al menos { $conformity }, precisión de vuelo { $precision }, seguridad ponderada por impacto { $safety }, exactitud de detección { $accuracy }
certification-job-scores-without-defects = conformidad ponderada por cobertura de al menos { $conformity }, precisión de vuelo { $precision }, seguridad ponderada por impacto { $safety }
certification-job-pictures = fotos con un máximo de { $resolution } mm/px ({ $width } del ancho en una fisura), { $blur } px de desenfoque por movimiento y { $incidence }° de incidencia
