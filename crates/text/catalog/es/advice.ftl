advice-lesson = La puntuación de una lección no importa. Cuando haya completado todos los pasos, haga el primer ejercicio.
advice-nothing-to-correct = Nada que corregir: haga el siguiente trabajo.
advice-certified = Ha obtenido la certificación y no destaca ningún error.
advice-not-certified = No destaca ningún error, pero todavía no obtiene la certificación: { $unmet }.
advice-fly-again = No destaca ningún error: repita el trabajo.
advice-not-finished = No destaca ningún error, pero el trabajo no está terminado: complételo.

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
        [slab_side] del tablero
        [arch_bottom] del arco
        [pier_circle] de la pila
        [girder_soffit] de las vigas
        [pier_cap] del cabezal de la pila
        [truss_panel] de la celosía
        [floor_system] del sistema de piso
        [barrel_soffit] de la bóveda
        [arch_ring] del anillo del arco
        [stay_cable] de los tirantes
       *[structure] de la estructura
    } { $when }: acérquese.
advice-too-close = Voló { $mean } m demasiado cerca { $surface ->
        [slab_side] del tablero
        [arch_bottom] del arco
        [pier_circle] de la pila
        [girder_soffit] de las vigas
        [pier_cap] del cabezal de la pila
        [truss_panel] de la celosía
        [floor_system] del sistema de piso
        [barrel_soffit] de la bóveda
        [arch_ring] del anillo del arco
        [stay_cable] de los tirantes
       *[structure] de la estructura
    } { $when }: aléjese.
advice-uneven-distance = Su distancia { $surface ->
        [slab_side] del tablero
        [arch_bottom] del arco
        [pier_circle] de la pila
        [girder_soffit] de las vigas
        [pier_cap] del cabezal de la pila
        [truss_panel] de la celosía
        [floor_system] del sistema de piso
        [barrel_soffit] de la bóveda
        [arch_ring] del anillo del arco
        [stay_cable] de los tirantes
       *[structure] de la estructura
    } varió y se apartó { $most } m a los { $at }: siga la forma de la trayectoria.
advice-uneven-height = Su altura sobre la trayectoria varió{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, hasta { $most } m a los { $at }: mantenga la altura.
advice-too-high = Voló { $mean } m por encima de la trayectoria { $when }: descienda hasta ella.
advice-too-low = Voló { $mean } m por debajo de la trayectoria { $when }: ascienda hasta ella.
advice-speeding = Alcanzó { $most } m/s{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, por encima del límite de { $limit } m/s { $when }: reduzca la velocidad.
advice-low-clearance = Estuvo a menos de { $limit } m de la estructura { $when }, a { $least } m en el punto más cercano: mantenga la distancia.
advice-stick-reversals = Invirtió el movimiento de las palancas hasta { $most } veces por minuto{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, sobre todo desde { $at }: haga correcciones pequeñas y suaves.
advice-stick-jumps = Movió bruscamente las palancas hasta { $most } veces por minuto{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, sobre todo desde los { $at }: muévalas gradualmente.
advice-yaw-reversals = Invirtió el movimiento de la palanca de guiñada hasta { $most } veces por minuto{ $place ->
        [task] {" "}en la tarea { $tasks }
        [tasks] {" "}en las tareas { $tasks }
       *[none] {""}
    }, sobre todo desde { $at }: mantenga el rumbo.

advice-framing = Su cámara se apartó hasta { $most } grados { $surface ->
        [slab_side] del tablero
        [arch_bottom] del arco
        [pier_circle] de la pila
        [girder_soffit] de las vigas
        [pier_cap] del cabezal de la pila
        [truss_panel] de la celosía
        [floor_system] del sistema de piso
        [barrel_soffit] de la bóveda
        [arch_ring] del anillo del arco
        [stay_cable] de los tirantes
       *[structure] de la estructura
    } { $when }: gire la nariz hacia la superficie.
advice-lamp-off = El foco estaba apagado en la oscuridad { $when }: enciéndalo en la sombra.

advice-crash-times = a los { $times }
advice-crash-first-and-hardest = la primera vez a los { $first }, la más fuerte a los { $hardest } ({ $speed } m/s)
advice-crash = Chocó con { $object ->
        [bridge] el puente
        [terrain] el suelo
        [water] el agua
        [vehicle] un vehículo
        [person] una persona
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
    }; el defecto { $defect } se veía con claridad a los { $at }: deténgase y tome una foto.
advice-missed-nearest = Omitió { $missed } de { $all } { $kind ->
        [severe] defectos graves
        [hidden] defectos que no dan hacia la trayectoria
        [cracks] fisuras
       *[all] defectos
    }; a los { $at } estuvo más cerca de ver el defecto { $defect }: busque allí despacio.
advice-passed-in-view = Pasó junto a { $count ->
        [one] un defecto
       *[other] { $count } defectos
    } a plena vista sin tomar una foto, el más largo durante { $seconds } s a los { $at }: vuele allí más despacio o más cerca.
advice-picture-failed = { $count ->
        [one] Su foto de un defecto no sirve
       *[other] Sus fotos de { $count } defectos no sirven
    } ({ $why ->
        [dark] demasiado oscuro
        [oblique] ángulo demasiado oblicuo
        [small] demasiado lejos
        [thin] demasiado lejos para una fisura fina
       *[other] { $reason }
    }), la primera a los { $at }: { $why ->
        [dark] encienda el foco
        [oblique] apunte la nariz de frente a la superficie
        [small] acérquese
        [thin] acérquese
       *[other] corríjalo antes de tomar la foto
    }.
advice-picture-poor =
    { $found ->
        [one] Sus fotos del defecto que encontró
       *[other] Sus fotos de { $count } de los { $found } defectos que encontró
    } { $why ->
        [blur] están movidas
        [coarse] tienen muy poca resolución
        [oblique] se tomaron en un ángulo demasiado oblicuo
       *[other] no son lo bastante buenas
    }, la primera a los { $at }: { $why ->
        [blur] deténgase antes de tomar la foto
        [coarse] acérquese
        [oblique] apunte la nariz de frente a la superficie
       *[other] consulte lo que el informe dice de cada una
    }.
advice-no-pictures =
    { $count ->
        [one] No tomó ninguna foto del defecto
       *[other] No tomó ninguna foto de los { $count } defectos
    }; su mejor oportunidad fue a los { $at }: fotografíe cada defecto.
advice-none-found =
    { $all ->
        [one] No fotografió el defecto
       *[other] No fotografió ninguno de los { $all } defectos
    }{ $place ->
        [task] {" "}de la tarea { $tasks }
        [tasks] {" "}de las tareas { $tasks }
       *[none] {""}
    }; a los { $at } estuvo más cerca de ver el defecto { $defect }: busque en cada tarea hasta el final.
advice-moving-pictures =
    { $taken ->
        [one] Tomó su única foto en movimiento, a los
       *[other] Tomó { $count } de { $taken } fotos en movimiento, { $count ->
            [one] a los
           *[other] la primera a los
        }
    } { $at }: deténgase antes de cada foto.
advice-drifting-pictures =
    { $taken ->
        [one] El dron derivaba cuando tomó su única foto, a los
       *[other] El dron derivaba en { $count } de { $taken } fotos, { $count ->
            [one] a los
           *[other] la primera a los
        }
    } { $at }: espere a que se detenga antes de cada foto.
advice-turning-pictures =
    { $taken ->
        [one] Estaba girando cuando tomó su única foto, a los
       *[other] Estaba girando en { $count } de { $taken } fotos, { $count ->
            [one] a los
           *[other] la primera a los
        }
    } { $at }: mantenga el rumbo hasta tomar la foto.
advice-unlit-pictures =
    { $count ->
        [one] El foco estaba apagado en una foto{ $place ->
        [task] {" "}de la tarea { $tasks }
        [tasks] {" "}de las tareas { $tasks }
       *[none] {""}
    }, a los
       *[other] El foco estaba apagado en { $count } fotos{ $place ->
        [task] {" "}de la tarea { $tasks }
        [tasks] {" "}de las tareas { $tasks }
       *[none] {""}
    }, la primera a los
    } { $at }: enciéndalo antes de la foto.
advice-pictures-of-nothing = { $taken ->
        [one] Su única foto, a los { $at }, no muestra ningún defecto nuevo
       *[other] { $count } de sus { $taken } fotos { $count ->
            [one] no muestra ningún defecto nuevo, a los { $at }
           *[other] no muestran ningún defecto nuevo, la primera a los { $at }
        }
    }: mire primero y luego tome la foto.

advice-not-attempted = No voló { $place ->
        [task] la tarea { $tasks }
        [tasks] las tareas { $tasks }
       *[none] la tarea
    }: el vuelo terminó a los { $at }.
advice-not-covered = Recorrió solo { $shares } { $place ->
        [task] de la trayectoria de la tarea { $tasks } y la dejó
        [tasks] de las trayectorias de las tareas { $tasks } y dejó la tarea { $least }
       *[none] de la trayectoria y la dejó
    } a los { $at }: recorra cada trayectoria hasta el final.
advice-overtime = Voló durante { $flown }, { $over } más de lo que permite la puntuación completa; el tiempo se cumplió a los { $at }: planifique el orden de las tareas.
advice-slow = Voló durante { $flown }; a velocidad de inspección, este trabajo dura { $needed }. Desde los { $at } ya iba por encima de ese tiempo: no se demore donde no hay nada que ver.
advice-landing = Su aterrizaje duró { $took } desde la última aproximación, a los { $at }: descienda de forma constante y tome tierra.
advice-not-landed = Su vuelo terminó a los { $at }, a { $away } m de la plataforma de aterrizaje: regrese y aterrice en ella.
advice-battery-low = Terminó con { $left }% de batería; la reserva de { $reserve }% se alcanzó a los { $at }: regrese antes.
advice-time-up = Su tiempo se agotó a los { $at }, a { $away } m de la plataforma de aterrizaje: regrese antes.
advice-battery-empty = Su batería se agotó a los { $at }, a { $away } m de la plataforma de aterrizaje: regrese antes.
