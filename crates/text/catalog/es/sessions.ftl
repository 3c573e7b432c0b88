sessions-title = Sesiones
sessions-trainee = Alumno
sessions-show = Mostrar
sessions-show-all = Mostrar todas
sessions-import = Importar vuelo
sessions-my-progress = Mi progreso y plan
sessions-none = Aún no hay sesiones. Los vuelos aparecen aquí cuando terminan.
sessions-count =
    { $count ->
        [one] { $count } sesión, las más recientes primero
       *[other] { $count } sesiones, las más recientes primero
    }
sessions-started = Inicio
sessions-overall = Total
sessions-overall-of = { $score } de { $most }
sessions-certified = Certificado
sessions-scenario = Escenario
sessions-purpose = Propósito
sessions-end = Fin

sessions-page = Sesión: { $scenario }
sessions-flight-time = tiempo de vuelo { $time }, { $end }
sessions-better = Qué mejorar
sessions-marks = Marcas
sessions-video = Video
sessions-pictures = Fotos
sessions-scores = Puntuaciones
sessions-certification = Certificación
sessions-tasks = Tareas
sessions-defects = Defectos
sessions-compare-with = Comparar con
sessions-show-moment = Mostrar { $time }
sessions-next-flight = Próximo vuelo, solo según esta sesión: { $job }.
sessions-plan = Plan de entrenamiento, según todas las sesiones
sessions-no-marks = Aún no hay marcas. Las marcas aparecen en la cronología del informe; no cambian la puntuación.
sessions-remove-mark = Quitar
sessions-remove-mark-at = Quitar la marca de { $time }
sessions-mark-time = Tiempo en el control deslizante del informe (minutos:segundos)
sessions-mark-text = Texto
sessions-your-name = Su nombre
sessions-add-mark = Agregar marca
sessions-mark-time-invalid = time = { $value }: tiempo no válido (permitido: de 0:00 a { $end }, minutos y segundos)
sessions-too-many-marks = Ya hay { $most } marcas: quite una antes.
sessions-picture = Foto { $number }
sessions-standing-best = Esta es la mejor puntuación personal en este trabajo.
sessions-standing-other = Mejor puntuación personal en este trabajo: { $best } de { $most }.
sessions-standing-same = Cambio desde la última vez: ninguno.
sessions-standing-up =
    Cambio desde la última vez: { $points ->
        [one] { $points } punto
       *[other] { $points } puntos
    } más.
sessions-standing-down =
    Cambio desde la última vez: { $points ->
        [one] { $points } punto
       *[other] { $points } puntos
    } menos.
sessions-standing-forms = Se comparan las sesiones con las variantes { $forms }, de igual dificultad.
sessions-report = Abrir el informe
sessions-questions-answer = Responder el cuestionario
sessions-questions-continue = Continuar el cuestionario ({ $answered } de { $all })
sessions-questions-view = Ver el cuestionario (respondidas: { $all } de { $all })
sessions-frames = Registros (CSV)
sessions-telemetry = Telemetría (tlog)
sessions-no-folder = La carpeta de la sesión no está en este equipo; por eso, el informe, el cuestionario y las descargas no están disponibles.
sessions-partial = Las puntuaciones siguientes abarcan solo la parte volada.
sessions-radar-caption = Las cuatro puntuaciones, 0 en el centro, 100 en el borde
sessions-radar = Gráfico radial de las cuatro puntuaciones
sessions-of-most = de { $most }
sessions-not-available = n/d
sessions-requirements = Requisitos
sessions-requirement = Requisito
sessions-reached = Alcanzado
sessions-needed = Necesario
sessions-met = Cumplido
sessions-yes = sí
sessions-no = no
sessions-not-attempted = no iniciada
sessions-on-path-by-task = Porcentaje en la trayectoria por tarea
sessions-task-results = Resultados de las tareas
sessions-task = Tarea
sessions-path-flown = Trayectoria recorrida
sessions-on-path = Porcentaje en la trayectoria (%)
sessions-speeding = Tiempo con exceso de velocidad (s)
sessions-crashes = Colisiones
sessions-defects-found = Defectos encontrados
sessions-found-of = { $found } de { $placed }
sessions-crashes-outside =
    { $count ->
        [one] { $count } colisión fuera de las tareas.
       *[other] { $count } colisiones fuera de las tareas.
    }
sessions-unknown = desconocido
sessions-defects-caption =
    { $found } de { $placed } encontrados; { $hits } de { $pictures ->
        [one] { $pictures } foto
       *[other] { $pictures } fotos
    } { $hits ->
        [one] mostró
       *[other] mostraron
    } un defecto nuevo
sessions-defect = Defecto
sessions-found = Encontrado
sessions-why-not = Por qué la mejor foto no contó
sessions-no-picture = no se tomó ninguna foto cerca
sessions-no-others = Este alumno aún no tiene otras sesiones.
sessions-other = Otra sesión
sessions-incomplete = incompleta
sessions-compare = Comparar
sessions-compare-missing = { $field }: falta (se requiere un identificador de sesión)
