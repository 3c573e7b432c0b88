people-trainees = Alumnos
people-pseudonym = Seudónimo
people-role = Rol
people-age = Edad
people-drones = Drones
people-games = Juegos
people-no-trainees = Aún no hay alumnos. Los alumnos aparecen aquí después de su primer vuelo.
people-users =
    { $count ->
        [one] { $count } usuario
       *[other] { $count } usuarios
    }
people-plan-rules = Reglas de los planes de entrenamiento
people-rubric = Rúbrica
people-experience-none = ninguna
people-experience-some = alguna
people-experience-regular = habitual

people-trainee = Alumno { $name }
people-assignments = Trabajos asignados
people-next-flights = Próximos vuelos
people-progress = Progreso
people-sessions = Sesiones
people-no-sessions = Aún no hay sesiones.
people-details = Datos
people-data = Datos guardados
people-download = Descargar todos los datos de { $name }
people-of-classes =
    { $count ->
        [one] Clase:
       *[other] Clases:
    }
people-plan-between = Vuele entre { $from } y { $until }.
people-plan-overdue = Ha pasado mucho tiempo desde el último vuelo, y las habilidades se pierden sin práctica.
people-plan-consequence = Consecuencia: { $reason }
people-plan-drills = Ejercicios
people-plan-drill = { $drill }: { $progress }.
people-plan-drill-next = { $drill }: { $progress }; siguiente nivel: { $level }.
people-changes = Cambios
people-changes-compared = En comparación con { $session }.
people-changes-session = la sesión anterior del mismo trabajo
people-changes-forms = Aquella sesión usó la variante { $before } y esta la variante { $now }, de igual dificultad.
people-change-better = { $what }: { $before } → { $now }, mejor
people-change-worse = { $what }: { $before } → { $now }, peor
people-include-incomplete = Incluir sesiones incompletas
people-exclude-incomplete = Excluir sesiones incompletas
people-job-sessions =
    { $count ->
        [one] { $count } sesión
       *[other] { $count } sesiones
    }
people-details-note = Rol: { $role }. La siguiente información es opcional y se usa solo para el estudio.
people-not-specified = sin especificar
people-age-years = Edad (años)
people-drone-experience = Experiencia con drones
people-gaming-experience = Experiencia con videojuegos
people-save = Guardar
people-details-changed = Estos datos se cambiaron en otro lugar: vuelva a cargar la página y revise los datos actuales.
people-erase = Borrar
people-erase-note = Esto borra a { $name } con todas sus sesiones, respuestas y carpetas de sesiones. No se puede deshacer.
people-erase-again = Escriba el seudónimo para confirmar
people-erase-button = Borrar definitivamente
people-erase-wrong-name = El seudónimo que escribió no es { $name }: no se borró nada.
people-erase-self = Usted perdería su propio acceso: pida a otro administrador que borre sus datos.

people-classes = Clases
people-no-classes = Aún no hay clases.
people-class-count =
    { $count ->
        [one] { $count } clase
       *[other] { $count } clases
    }
people-class = Clase
people-members = Integrantes
people-new-class = Clase nueva
people-name = Nombre
people-new-class-note = Letras sin tilde ni ñ, dígitos, - y _. Un alumno puede estar en varias clases.
people-create-class = Crear clase
people-class-title = Clase { $name }
people-no-members = Aún no hay alumnos en esta clase.
people-no-class-jobs = No hay trabajos asignados a esta clase.
people-assign-to-class = Asignar un trabajo a esta clase
people-add-trainees = Agregar alumnos
people-add-pseudonyms = Seudónimos, separados por espacios o comas
people-add-note = Puede agregar alumnos antes de su primer vuelo.
people-add-button = Agregar a la clase
people-delete = Eliminar
people-delete-this-class = Eliminar esta clase
people-delete-note = Esto elimina la clase y sus asignaciones. Los alumnos y sus sesiones se conservan.
people-delete-class = Eliminar clase
people-head-trainee = Alumno
people-head-last = Última sesión
people-head-certified = Certificado
people-head-next = Recomendado a continuación
people-head-open = Trabajos pendientes
people-head-change = Cambiar
people-not-flown = aún sin volar
people-remove = Quitar
people-remove-member = Quitar a { $name } de esta clase
people-trainee-count =
    { $count ->
        [one] { $count } alumno
       *[other] { $count } alumnos
    }
people-job-level = { $job }, nivel { $level }
people-class-name = name = { $name }: nombre de clase no válido (permitido: de 1 a 32 letras sin tilde ni ñ, dígitos, «-» o «_», y al principio una letra o un dígito)
people-class-exists = name = { $name }: ya existe una clase con este nombre.
people-too-many-members =
    { $count ->
        [one] trainees: { $count } seudónimo (permitido: de 1 a { $most } a la vez)
       *[other] trainees: { $count } seudónimos (permitido: de 1 a { $most } a la vez)
    }
people-lookalike = trainees: no existe «{ $name }», pero sí «{ $other }»; use ese seudónimo.

people-no-open = No hay trabajos pendientes.
people-open-count =
    { $count ->
        [one] { $count } trabajo pendiente
       *[other] { $count } trabajos pendientes
    }
people-done-count = Terminados ({ $count })
people-finished = Trabajos terminados
people-assign-to = Asignar un trabajo a { $name }
people-job = Trabajo
people-due = Fecha límite
people-state = Estado
people-assigned-to = Asignado a
people-to-fly = Cómo volarlo
people-change = Cambiar
people-assigned-by = { $target }, por { $instructor }
people-job-level-or-harder = { $job }, nivel { $level } o más difícil
people-job-form = { $job }, variante { $form }
people-target-class = clase { $name }
people-remove-assignment = Quitar la asignación de { $job }
people-none = ninguno
people-overdue-since = vencido desde { $day }
people-due-on = fecha límite { $day }
people-done = Terminado
people-open = Pendiente
people-overdue = Vencido
people-assignment-count =
    { $count ->
        [one] { $count } asignación
       *[other] { $count } asignaciones
    }
people-assign = Asignar
people-assign-job-to = Asignar { $job } a { $name }
people-choice-levels = { $job } (niveles { $first } a { $last })
people-choice-forms = { $job } (variantes: { $forms })
people-assign-note = La asignación queda terminada después del primer vuelo completo del trabajo que comience después de asignarlo.
people-assign-variant = Nivel o variante (opcional)
people-assign-variant-note = Un nivel más difícil también cuenta. Sin nivel ni variante, cuenta cualquiera.
people-assign-due = Fecha límite (fin del día, UTC)
people-assign-title-trainee = Asignar un trabajo a { $name }
people-assign-title-class = Asignar un trabajo a la clase { $name }
people-assign-one-target = Se requiere un alumno o una clase, no ambos.
people-assign-variant-unknown = variant = { $value }: nivel o variante desconocidos de { $job } (permitido: { $allowed })
people-assign-no-variants = variant = { $value }: nivel o variante desconocidos de { $job } (el trabajo no tiene niveles ni variantes)
people-assign-due-invalid = due = { $value }: fecha no válida (permitido: de { $first } a { $last })

people-rubric-count = { $signed } de { $all } criterios aprobados
people-rubric-of = Rúbrica de { $name }
people-criteria = Criterios
people-history = Historial
people-no-history = Aún no se aprobó nada.
people-edit-criteria = Editar los criterios
people-signed = Aprobado
people-signed-by = { $signed } el { $day } por { $instructor }
people-signed-by-with-note = { $signed } el { $day } por { $instructor }: { $note }
people-not-signed = Sin aprobar
people-withdraw = Retirar
people-note-optional = Nota (opcional)
people-sign = Aprobar
people-reason = Motivo
people-withdraw-sign-off = Retirar la aprobación
people-your-name = Su nombre
people-button-for = { $button }: { $criterion }
people-erased-user = un usuario borrado
people-time = Hora
people-criterion = Criterio
people-action = Acción
people-by = Por
people-note = Nota
people-history-count =
    { $count ->
        [one] { $count } entrada, las más recientes primero
       *[other] { $count } entradas, las más recientes primero
    }
people-rubric-own = Los criterios que los instructores aprueban para cada alumno. Este servidor usa su propia rúbrica.
people-rubric-shipped = Los criterios que los instructores aprueban para cada alumno. Este servidor usa la rúbrica incluida.
people-rubric-note = Las aprobaciones pertenecen al identificador de un criterio. Si quita un criterio, sus aprobaciones permanecen en el historial.
people-rubric-edit = Editar
people-rubric-toml = Rúbrica (TOML)
people-rubric-reset = Rúbrica incluida
people-rubric-delete = Eliminar la rúbrica propia
people-rubric-saved = La rúbrica se guardó y se aplica a partir de ahora.
people-rubric-invalid = La rúbrica propia de este servidor no es válida; por eso se aplica la incluida. Los instructores pueden corregirla.
people-already-signed = { $criterion }: ya está aprobado; vuelva a cargar la página
people-already-withdrawn = { $criterion }: ya está retirado; vuelva a cargar la página

people-answer-invalid = { $field } = { $value }: respuesta no válida (permitido: de { $least } a { $most })
people-answer-invalid-step = { $field } = { $value }: respuesta no válida (permitido: de { $least } a { $most } en pasos de { $step })

people-cohort = Cohorte
people-cohort-scenarios = Escenarios que se incluyen
people-cohort-repetitions = Repeticiones
people-cohort-show = Mostrar
people-cohort-download = Descargar como página sin conexión
people-cohort-nothing = Estos escenarios no tienen sesiones que incluir.
