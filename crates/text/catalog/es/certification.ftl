certification-tasks-done = tareas terminadas
certification-landed-at-home = aterrizaje en la base
certification-person-or-vehicle-hits = colisiones con personas o vehículos
certification-battery = batería al aterrizar
certification-contacts = contactos
certification-contact-speed = contacto más rápido
certification-conformity = conformidad
certification-precision = precisión
certification-safety = seguridad
certification-accuracy = exactitud
certification-practice-aids = veces que se congeló o rebobinó

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
certification-unmet-contacts = { $contacts } contactos, se permiten como máximo { $limit }
certification-unmet-contact-speed = contacto a { $speed }, se permite como máximo { $limit }
certification-unmet-score = { $score ->
        [conformity] conformidad
        [precision] precisión
        [safety] seguridad
        [accuracy] exactitud
       *[other] { $score }
    } { $value }, se requiere { $needed }
certification-unmet-no-evidence = sin datos para: { $score ->
        [conformity] conformidad
        [precision] precisión
        [safety] seguridad
        [accuracy] exactitud
       *[other] { $score }
    }

certification-picture-of-defect = defecto { $defect }: { $reason }
certification-picture-resolution = resolución { $value } mm/px, límite { $limit } mm/px
certification-picture-motion-blur = desenfoque por movimiento { $value } px, límite { $limit } px
certification-picture-incidence = incidencia { $value }°, límite { $limit }°
certification-picture-too-fine = demasiado fino para esta cámara
certification-picture-not-central = fuera del 80% central de la imagen
certification-picture-hidden = oculto detrás de algo
certification-picture-too-oblique = demasiado oblicuo: { $value }°, límite { $limit }°
certification-picture-too-small = demasiado pequeño: { $value } px, al menos { $limit } px
certification-picture-line-too-thin = línea demasiado fina: { $value } px, al menos { $limit } px
certification-picture-dark-lamp-on = demasiado oscuro: foco encendido, { $value } lx de { $limit } lx necesarios
certification-picture-dark-lamp-off = demasiado oscuro: foco apagado, { $value } lx de { $limit } lx necesarios

certification-job-tasks = cada tarea recorrida en al menos { $share }% de su trayectoria
certification-job-landing = aterrizaje en la base con al menos { $battery }% de batería, sin colisiones con personas ni vehículos
certification-job-aids = sin congelar ni rebobinar, que son ayudas de práctica
certification-job-contacts = como máximo { $contacts } contactos, ninguno a más de { $speed } m/s
certification-job-scores = conformidad de al menos { $conformity }, precisión { $precision }, seguridad { $safety }, exactitud { $accuracy }
certification-job-pictures = fotos con un máximo de { $resolution } mm/px ({ $width } del ancho en una fisura), { $blur } px de desenfoque por movimiento y { $incidence }° de incidencia
