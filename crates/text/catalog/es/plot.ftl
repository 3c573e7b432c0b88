## Plots

plot-not-applicable = n/a

## Site drawings

plot-flight-plan = Vuelo desde arriba, norte arriba
plot-flight-oblique = Vista oblicua del vuelo, hacia el norte
plot-flight-side = Vista lateral del vuelo en el puente «{ $bridge }»
plot-flight-south = Vuelo visto desde el sur
plot-defect = defecto { $defect }: { $outcome }
plot-reference = trayectoria de referencia de la tarea { $task }
plot-crash = colisión ({ $object }) a los { $moment }
plot-session-crash = sesión { $session }: colisión ({ $object }) a los { $moment }
plot-session = sesión { $session }
plot-picture = foto { $picture }: { $verdict }
plot-pad = plataforma
plot-inspector = inspector
plot-place = punto { $place } del inspector
plot-walk = el inspector camina al punto { $place } a los { $moment }
plot-truck = camioneta
plot-north = N
plot-both-plan = Ambos vuelos desde arriba, norte arriba
plot-both-side = Vista lateral de ambos vuelos en el puente «{ $bridge }»
plot-both-south = Ambos vuelos vistos desde el sur
plot-job-plan = Sitio del trabajo desde arriba, norte arriba
plot-job-side = Vista lateral del puente «{ $bridge }»
plot-job-south = Sitio del trabajo visto desde el sur
plot-site-picture = Imagen del sitio
plot-color-path = trayectoria
plot-color-speed = velocidad
plot-color-clearance = separación
plot-legend-between = entre tareas
plot-legend-on-path = en la trayectoria
plot-legend-off-path = fuera de la trayectoria durante una tarea
plot-legend-speed = hasta { $speed } m/s
plot-legend-speeding = sobre el límite de { $speed } m/s
plot-legend-far = nada cerca
plot-legend-over = más de { $limit } m
plot-legend-range = { $low } a { $high } m
plot-legend-under = menos de { $limit } m
plot-air = { $caption }. Velocidad media del aire en el plano: de { $slowest } a { $fastest } m/s
plot-air-place = { $number }: { $speed } m/s de diferencia con el viento libre en { $moment }
plot-legend-air-speed = { $low } a { $high } m/s
plot-legend-air-arrow = dirección y velocidad en el plano
plot-legend-air-turbulence = turbulencia desde el { $share }% del viento libre
plot-legend-air-flown = volado cerca del plano
plot-legend-air-flown-far = volado por encima o por debajo
plot-legend-air-deck = bordes del tablero

## Statistics

plot-box =
    { $name }: mediana { $median }, cuartiles { $low } a { $high }, { $trainees ->
        [one] { $trainees } alumno
       *[other] { $trainees } alumnos
    }
plot-bin = { $count }, de { $low } a { $high }
plot-mean = media { $mean }
plot-predicted = próxima prevista: { $value }
plot-model-demand = Demanda
plot-model-demand-parts = mental, física
plot-model-strain = Tensión
plot-model-strain-parts = presión, frustración
plot-model-performance = Rendimiento
plot-model-performance-parts = puntuación total (%)
plot-model-feedback = Avisos
plot-model-feedback-parts = utilidad
