job-certification = Certificación: dos puentes, 26 defectos
job-drill-curve-under-arch = Ejercicio: curva bajo el arco
job-drill-framing = Ejercicio: encuadre
job-drill-gap = Ejercicio: paso estrecho
job-drill-hover = Ejercicio: vuelo estacionario
job-drill-lamp = Ejercicio: foco
job-drill-landing = Ejercicio: aterrizaje
job-drill-orbit = Ejercicio: órbita
job-drill-search = Ejercicio: búsqueda
job-drill-stand-off = Ejercicio: distancia a la superficie
job-drill-straight-line = Ejercicio: línea recta
job-first-flight = Lección: primer vuelo
job-girder = Puente de vigas: viga exterior, espacios entre vigas, cabezal, apoyos
job-pilot-study = Estudio piloto: costado del tablero, intradós del arco, espacio intermedio, pila
job-practice = Práctica en dos puentes
job-prestressed = Puente de vigas pretensadas: viga exterior, espacios entre vigas, cabezal, apoyos
job-two-bridges = Dos puentes: costado del tablero, intradós del arco, espacio intermedio, pila

job-task-curve = Curva bajo el arco
job-task-slab-framing = Costado del tablero, cámara hacia el tablero
job-task-gap = Paso estrecho entre el tablero y el arco
job-task-hover = Vuelo estacionario
job-task-dark-arch = Intradós del arco en la oscuridad
job-task-out-and-back = Ida y vuelta
job-task-orbit = Órbita
job-task-pier-faces = Pila, todas las caras
job-task-pier-stand-off = Pila a 3 m
job-task-straight-line = Línea recta
job-task-square = Cuadrado
job-task-slab = Tablero del puente de arco desde un costado
job-task-arch = Intradós en forma de arco
job-task-interlayer = Espacio intermedio entre el tablero y el arco
job-task-pier = Pila del puente colgante cerca del agua
job-task-outer-girder = Viga exterior y borde del tablero
job-task-girder-bays = Espacios entre vigas del último vano
job-task-bearings = Apoyos del estribo inicial
job-task-pier-cap = Cabezal de la primera pila
job-task-middle-bays = Espacios entre vigas del vano central
job-task-pier-bearings = Apoyos de la segunda pila

job-state-open = pendiente
job-state-overdue = vencido
job-state-done = terminado
job-state-done-late = terminado con retraso

# How a trainee flies a job.
job-how-to-fly = En la ventana del simulador, elija este trabajo en la página de inicio.
job-how-to-fly-assigned = En la página de inicio de la ventana del simulador: { $row }
