briefing-aircraft = aeronave
briefing-tasks = tareas
briefing-time = tiempo
briefing-speed = velocidad
briefing-defects = defectos
briefing-wind = viento
briefing-light = luz
briefing-sky = cielo
briefing-traffic = tráfico

briefing-tasks-and-length = { $tasks }, { $length } m de trayectoria
briefing-time-needed = unos { $needed } min necesarios, { $allowed } min permitidos
briefing-speed-limit = { $speed } m/s para la inspección, límite { $limit }
briefing-no-defects = ninguno
briefing-defects-to-find = { $count } por encontrar
briefing-wind-from = { $wind } desde { $bearing }°
briefing-calm = en calma
briefing-sun = { $time } hora solar, sol a { $height }°
briefing-no-sun = { $time } hora solar, sin sol
briefing-clouds = { $share }% de nubes
briefing-visibility = alcance visual { $distance } m
briefing-rain = lluvia { $rate } mm/h
briefing-snow = nieve { $rate } mm/h
briefing-cars = { $count ->
        [one] { $count } auto
       *[other] { $count } autos
    }
briefing-trucks = { $count ->
        [one] { $count } camión
       *[other] { $count } camiones
    }
briefing-pedestrians = { $count ->
        [one] { $count } peatón
       *[other] { $count } peatones
    }
briefing-drones = { $count ->
        [one] { $count } dron más
       *[other] { $count } drones más
    }

briefing-hover = vuelo estacionario en un punto
briefing-place = { $kind ->
        [slab_side] a lo largo del borde del tablero
        [arch_bottom] bajo el arco
        [interlayer] entre el arco y el tablero
        [pier_circle] alrededor de la pila
        [girder_soffit] bajo las vigas
        [bearing_line] a lo largo de los apoyos
        [pier_cap] alrededor del cabezal de la pila
        [truss_panel] a lo largo del exterior de la celosía
        [floor_system] bajo el sistema de piso
        [barrel_soffit] bajo la bóveda
        [arch_ring] a lo largo del anillo del arco
        [stay_cable] a lo largo del tirante
       *[free] a lo largo de la trayectoria libre
    }{ $named ->
        [yes] {" "}del puente «{ $bridge }»
       *[no] {""}
    }
briefing-place-and-way = { $place }, { $way }
briefing-way-loop = una vuelta, en cualquier sentido
briefing-way-back = termina donde empieza
briefing-way-up = de abajo hacia arriba
briefing-way-down = de arriba hacia abajo
briefing-way = de { $from } a { $to }
briefing-north = norte
briefing-northeast = noreste
briefing-east = este
briefing-southeast = sureste
briefing-south = sur
briefing-southwest = suroeste
briefing-west = oeste
briefing-northwest = noroeste
briefing-length = { $length } m de largo
briefing-height-above = a { $height } m sobre la plataforma de aterrizaje
briefing-height-below = a { $height } m bajo la plataforma de aterrizaje
briefing-heights = de { $low } a { $high } m sobre la plataforma de aterrizaje
briefing-stand-off = distancia a la superficie { $distance } ± { $tolerance } m
briefing-within = a menos de { $distance } m de la trayectoria
briefing-lamp-needed = se necesita el foco

briefing-confined = Espacio reducido: en la tarea { $task }, la estructura queda a { $clearance } m de la trayectoria.
briefing-darkness = Oscuridad: se necesita el foco en { $count ->
        [one] la tarea { $tasks }
       *[other] las tareas { $tasks }
    }.
briefing-vehicles = Tráfico: { $count ->
        [one] { $count } vehículo
       *[other] { $count } vehículos
    } en los puentes. Manténgase lejos de la calzada.
briefing-people = Personas: { $count ->
        [one] { $count } peatón
       *[other] { $count } peatones
    } en las aceras. Nunca vuele sobre personas.
briefing-other-drones = Otros drones: { $count ->
        [one] { $count } dron vuela aquí por una trayectoria fija y no se aparta. No lo pierda de vista y mantenga la distancia.
       *[other] { $count } drones vuelan aquí por trayectorias fijas y no se apartan. No los pierda de vista y mantenga la distancia.
    }
briefing-ropes = Cuerdas: aquí { $count ->
        [one] cuelga { $count } cuerda o cable que oscila
       *[other] cuelgan { $count } cuerdas o cables que oscilan
    } con el viento. Los sensores de distancia apenas los ven: vigile las imágenes.
briefing-satellites = GNSS: la estructura bloquea los satélites. Bajo el tablero, la posición puede derivar.
briefing-compass = Brújula: el acero distorsiona el campo magnético. Cerca de elementos de acero, el rumbo indicado puede desviarse y la posición, derivar.
briefing-wakes = Estelas: detrás de pilas y torres, el viento es más débil y turbulento, y oscila. En los bordes del tablero cambia de repente, y debajo de él es más rápido.
briefing-cold-battery = Batería fría ({ $temperature } °C): su tensión cae en los ascensos, de modo que el dron tiene menos empuje.
briefing-flow-over-water = Agua: el flujo óptico y el telémetro inferior no son fiables sobre el agua, de modo que la posición puede derivar.
briefing-real-sky = GNSS: los puentes ocultan satélites, y el agua y las paredes reflejan sus señales. Cerca y debajo de los puentes, la posición y sobre todo la altura pueden ser erróneas y saltar cuando los satélites reaparecen.
briefing-radio = Radio: el hormigón y el acero debilitan las señales entre usted y el dron. Detrás o debajo de un puente, primero se deteriora la imagen y después se pierde el control.
briefing-water = Agua: partes de las trayectorias están sobre el agua. Un aterrizaje de emergencia allí supone perder la aeronave.
briefing-crash-ends = Una colisión termina la sesión.
briefing-wind-force = Viento: una fuerza de { $force } N.{ $changes ->
        [yes] {" "}Cambia o tiene ráfagas durante el vuelo.
       *[no] {""}
    } Prevea que lo empuje fuera de la trayectoria.
briefing-wind-speed = Viento: { $speed } m/s en promedio.{ $changes ->
        [yes] {" "}Cambia o tiene ráfagas durante el vuelo.
       *[no] {""}
    } Prevea turbulencia detrás de las pilas y bajo el tablero.

briefing-conformity = Conformidad: manténgase en la trayectoria y, mientras esté en ella, por debajo del límite de velocidad.
briefing-efficiency = Eficiencia: aterrice antes de que se acabe el tiempo y antes de que se agote la batería.
briefing-safety = Seguridad: no toque nada. Una colisión con una persona o un vehículo termina la sesión.
briefing-accuracy = Exactitud: fotografíe cada defecto una vez, cerca del centro de la foto, y nada más.
briefing-to-be-certified = Para la certificación: { $requirement }.

briefing-check-risk = Riesgo: conozco los peligros y me detengo si alguien entra en el área de vuelo.
briefing-check-battery = Batería: llena. Aterrizo con al menos { $least }% y regreso a la base con el aviso de batería baja ({ $low }%).
briefing-check-landing = Lugar de aterrizaje: la plataforma, a { $away } m del inspector. Los aterrizajes a menos de { $radius } m de ella cuentan como en la base.
briefing-check-places = Línea de vista: mantengo el dron a la vista. Para ello puedo caminar a { $count ->
        [one] otro punto
       *[other] otros { $count } puntos
    } del plano.

# At a terminal, below the briefing.
briefing-confirm = Pulse Intro para confirmar la revisión del sitio. Después comienza el vuelo.
