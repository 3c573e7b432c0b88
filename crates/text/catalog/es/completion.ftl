completion-task-done = terminada ({ $share }% de la trayectoria)
completion-task-part = recorrida en parte ({ $share }% de la trayectoria)
completion-task-not-attempted = no iniciada
completion-complete = Completo: { $done } de { $tasks ->
        [one] { $tasks } tarea
       *[other] { $tasks } tareas
    }, { $share }% de la trayectoria
completion-incomplete = Incompleto: { $done } de { $tasks ->
        [one] { $tasks } tarea
       *[other] { $tasks } tareas
    }, { $share }% de la trayectoria
completion-not-landed = Incompleto: { $done } de { $tasks ->
        [one] { $tasks } tarea
       *[other] { $tasks } tareas
    }, { $share }% de la trayectoria, sin aterrizar en la base
completion-unknown = Se desconoce si está completa: importe de nuevo esta sesión
completion-excluded-sessions = { $count ->
        [one] { $count } sesión incompleta excluida
       *[other] { $count } sesiones incompletas excluidas
    }
completion-included-sessions = { $count ->
        [one] { $count } sesión incompleta incluida
       *[other] { $count } sesiones incompletas incluidas
    }
completion-certified = Certificado
completion-not-certified = No certificado
completion-not-certified-why = No certificado: { $unmet }
completion-not-certified-more = No certificado: { $unmet } (y { $more } más)

completion-rewound = { $rewinds ->
        [1] rebobinada una vez
        [2] rebobinada dos veces
       *[other] rebobinada { $rewinds } veces
    }
completion-frozen = { $freezes ->
        [1] congelada una vez
        [2] congelada dos veces
       *[other] congelada { $freezes } veces
    }
completion-rewound-and-frozen = { $rewound } y { $frozen }
