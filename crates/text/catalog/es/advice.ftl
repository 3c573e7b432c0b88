advice-lesson = La puntuación de una lección no importa. Cuando haya completado todos los pasos, vuele el primer ejercicio.
advice-nothing-to-correct = Nada que corregir: vuele el siguiente trabajo.
advice-not-certified = No destaca ningún error, pero todavía no obtiene la certificación: { $unmet }.
advice-fly-again = No destaca ningún error: vuele otra vez el trabajo.
advice-not-finished = No destaca ningún error, pero el trabajo no está terminado: vuélelo hasta el final.

advice-and = { $first } y { $last }
advice-when = { $place ->
        [task] en la tarea { $tasks } durante
        [tasks] en las tareas { $tasks } durante
       *[none] durante
    } { $time }{ $stretches ->
        [one] {" "}desde { $from }
       *[other] , el tramo más largo desde { $from }
    }

advice-off-path = Se salió de la trayectoria { $when }, hasta { $most } m: regrese a ella antes de seguir.
advice-drifted-up = Se desvió { $mean } m por encima de la trayectoria { $when }: mantenga la altura.
advice-drifted-down = Se desvió { $mean } m por debajo de la trayectoria { $when }: mantenga la altura.
advice-beside-path = Voló a { $mean } m de la trayectoria { $when }: vuele sobre la trayectoria misma.
advice-too-far = Voló { $mean } m demasiado lejos { $surface ->
        [deck] del tablero
        [arch] del arco
        [pier] de la pila
       *[structure] de la estructura
    } { $when }: acérquese.
advice-too-close = Voló { $mean } m demasiado cerca { $surface ->
        [deck] del tablero
        [arch] del arco
        [pier] de la pila
       *[structure] de la estructura
    } { $when }: aléjese.
advice-too-high = Voló { $mean } m por encima de la trayectoria { $when }: descienda hasta ella.
advice-too-low = Voló { $mean } m por debajo de la trayectoria { $when }: ascienda hasta ella.
advice-speeding = Voló hasta a { $most } m/s{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, por encima del límite de { $limit } m/s { $when }: reduzca la velocidad.
advice-low-clearance = Estuvo a menos de { $limit } m de la estructura { $when }, a { $least } m como mínimo: mantenga la distancia.
advice-stick-reversals = Invirtió el movimiento de las palancas hasta { $most } veces por minuto{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, sobre todo desde { $at }: haga correcciones pequeñas y suaves.
advice-yaw-reversals = Invirtió el movimiento de la palanca de guiñada hasta { $most } veces por minuto{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, sobre todo desde { $at }: mantenga el rumbo.

advice-framing = Su cámara apuntó hasta { $most } grados fuera { $surface ->
        [deck] del tablero
        [arch] del arco
        [pier] de la pila
       *[structure] de la estructura
    } { $when }: gire la nariz hacia la superficie.
advice-lamp-off = Su foco estaba apagado en la oscuridad { $when }: enciéndalo en la sombra.

advice-crash-times = en { $times }
advice-crash-first-and-hardest = la primera vez en { $first }, la más fuerte en { $hardest } ({ $speed } m/s)
advice-crash = Golpeó { $object ->
        [bridge] el puente
        [terrain] el suelo
        [water] el agua
        [vehicle] un vehículo
        [person] a una persona
        [other] un obstáculo
        [none] nada
       *[several] obstáculos
    } { $count ->
        [1] una vez
        [2] dos veces
       *[other] { $count } veces
    }{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
        [between] {" "}entre las tareas
       *[none] {""}
    }, { $when }: { $remedy ->
        [altitude] mantenga la altura
        [people] aléjese de las personas y del tráfico
       *[distance] mantenga la distancia
    }.

advice-missed-in-view = Omitió { $missed } de { $all } { $kind ->
        [severe] defectos graves
        [hidden] defectos que no dan hacia la trayectoria
        [cracks] fisuras
       *[all] defectos
    }; el defecto { $defect } se veía con claridad en { $at }: deténgase y tome una imagen.
advice-missed-nearest = Omitió { $missed } de { $all } { $kind ->
        [severe] defectos graves
        [hidden] defectos que no dan hacia la trayectoria
        [cracks] fisuras
       *[all] defectos
    }; en { $at } estuvo más cerca de ver el defecto { $defect }: busque allí despacio.
advice-passed-in-view = Pasó junto a { $count ->
        [one] un defecto
       *[other] { $count } defectos
    } a plena vista sin tomar una imagen, el más largo durante { $seconds } s en { $at }: vuele allí más despacio o más cerca.
advice-picture-failed = { $count ->
        [one] Su imagen de un defecto no sirve
       *[other] Sus imágenes de { $count } defectos no sirven
    } ({ $why ->
        [dark] demasiado oscuro
        [oblique] ángulo demasiado plano
        [small] demasiado lejos
        [thin] demasiado lejos para una fisura fina
       *[other] { $reason }
    }), la primera en { $at }: { $why ->
        [dark] encienda el foco
        [oblique] apunte la nariz de frente a la superficie
        [small] acérquese
        [thin] acérquese
       *[other] corríjalo antes de tomar la imagen
    }.
advice-picture-poor = Sus imágenes de { $count } de los { $found } defectos que encontró { $why ->
        [blur] están movidas
        [coarse] tienen muy poca resolución
        [oblique] se tomaron en un ángulo demasiado plano
       *[other] no son lo bastante buenas
    }, la primera en { $at }: { $why ->
        [blur] deténgase antes de tomar la imagen
        [coarse] acérquese
        [oblique] apunte la nariz de frente a la superficie
       *[other] consulte lo que el informe dice de cada una
    }.
advice-no-pictures = No tomó ninguna imagen de los { $count } defectos; su mejor oportunidad fue en { $at }: fotografíe cada defecto.
advice-pictures-of-nothing = { $count } de sus { $taken } imágenes no muestran ningún defecto nuevo, la primera en { $at }: mire primero y luego tome la imagen.

advice-not-attempted = No voló { $place ->
        [task] la tarea { $tasks }
        [tasks] las tareas { $tasks }
       *[none] la tarea
    }: el vuelo terminó en { $at }.
advice-not-covered = Voló solo { $shares } { $place ->
        [task] de la trayectoria de la tarea { $tasks } y la dejó
        [tasks] de las trayectorias de las tareas { $tasks } y dejó la tarea { $least }
       *[none] de la trayectoria y la dejó
    } en { $at }: vuele cada trayectoria hasta el final.
advice-overtime = Voló durante { $flown }, { $over } más de lo que permite la puntuación completa; el tiempo se cumplió en { $at }: planifique el orden de las tareas.
advice-not-landed = Su vuelo terminó en { $at }, a { $away } m de la plataforma de aterrizaje: regrese y aterrice en ella.
advice-battery-low = Terminó con { $left }% de batería; la reserva de { $reserve }% se alcanzó en { $at }: regrese antes.
advice-time-up = Su tiempo se agotó en { $at }, a { $away } m de la plataforma de aterrizaje: regrese antes.
advice-battery-empty = Su batería se agotó en { $at }, a { $away } m de la plataforma de aterrizaje: regrese antes.
