## All pages

window-back = Atrás (Esc)
window-help = Arriba/abajo: elegir; izq./der.: cambiar; Enter: confirmar; o clic.
window-help-dialog = Arriba/abajo: elegir; Enter: confirmar; o clic.
window-language = Language / Sprache / Idioma
window-on = sí
window-off = no

## Start page

window-start-title = Spandrel: inspeccione un puente con un dron
window-start-trainee = Alumno
window-start-job = Trabajo
window-start-aircraft = Aeronave
window-start-purpose = Propósito
window-start-check-controller = Siguiente: revisar el control
window-start-watch-expert = Ver a un experto volar este trabajo
window-start-tutorial = Leer el tutorial
window-start-school = Escuela de defectos: reconocer defectos en fotos
window-start-settings = Ajustes: teclas, unidades, texto, sonido
window-start-quit = Salir
window-start-recommended = Recomendado: { $job }
window-start-assigned = Asignado, vence el { $date }: { $job }
window-start-enter-name = Escriba un seudónimo, no un nombre real.
window-start-no-sessions = Aún no hay sesiones. Para cambiar el seudónimo, escriba otro.
window-start-from-last-session = Esta recomendación se basa solo en su última sesión. Con las páginas web activadas, considera todas.
window-start-sessions =
    { $count ->
        [one] Una sesión hasta ahora.
       *[other] { $count } sesiones hasta ahora.
    }
window-start-tutorial-first = Su primera práctica empieza con un tutorial.
window-start-last-flight = Último vuelo: { $words }
window-start-about-practice = Puede pausar y reiniciar; el mapa muestra las trayectorias.
window-start-about-assessment = Un solo intento: sin pausa, reinicio ni mapa.
window-start-web = Ver las sesiones en el navegador
window-start-name-characters = Use letras sin tilde ni ñ, dígitos, «-» y «_»; empiece con una letra o un dígito.
window-start-name-length = Como máximo { $count } caracteres.
window-start-name-first = Escriba primero un seudónimo.

## Waiting

window-waiting-simulator = Iniciando el simulador ...
window-waiting-scoring = Puntuando el vuelo ...
window-waiting-pictures = Preparando las fotos ...
window-waiting-briefing = Preparando las instrucciones ...

## Briefing

window-briefing-title = Instrucciones: { $job }
window-briefing-acknowledge = He leído esto y revisé el sitio: volar
window-briefing-print = Imprimir las instrucciones
window-briefing-site-check = Revisión del sitio
window-briefing-tasks = Tareas, en este orden
window-briefing-conditions = Condiciones
window-briefing-hazards = Peligros
window-briefing-counts = Lo que cuenta
window-briefing-notes = De su instructor
window-briefing-map = Mapa
window-briefing-side = Puente «{ $bridge }» visto de lado
window-briefing-from-south = Desde el sur

## Controller

window-controls-title = Revise el control
window-controls-none = No se encontró ningún control. Use el teclado.
window-controls-lost = { $name } desconectado: se usa el teclado
window-controls-calibrated = { $name }, calibrado
window-controls-not-calibrated = { $name }, sin calibrar: se usa el teclado
window-controls-fly = Iniciar vuelo
window-controls-calibrate = Calibrar
window-controls-calibrate-again = Calibrar de nuevo
window-controls-search = Buscar control
window-controls-mode = Modo
window-controls-dead-band = Zona muerta
window-controls-expo = Expo
window-controls-continue = Continuar (Enter)
window-controls-cancel = Cancelar (Esc)
window-controls-press-keys = Pulse las teclas de vuelo; los puntos deben seguirlas. Para continuar, use Tab y Enter o el ratón.
window-controls-move-sticks = Mueva las palancas; los puntos deben seguirlas, volver al centro y llegar a todos los bordes.
window-controls-left-stick = palanca izquierda
window-controls-right-stick = palanca derecha
window-controls-vertical = vertical: { $words }
window-controls-horizontal = horizontal: { $words }
window-controls-pitch = adelante, atrás
window-controls-throttle = subir, bajar
window-controls-roll = izquierda, derecha
window-controls-yaw = girar
window-controls-axis = eje { $number }
window-controls-no-axis = Aún no se ha movido ningún eje.
window-controls-note-none = No hay ningún control ni transmisor conectado.
window-controls-note-no-match = Ningún dispositivo coincide con '{ $wanted }' (conectados: { $connected }).
window-controls-note-ambiguous = Coincide más de un dispositivo ({ $connected }). Deje conectado solo uno.
window-controls-note-no-access = No se pueden usar controles en este equipo: { $error }
window-controls-note-unsupported = Este programa se compiló sin compatibilidad con controles.
window-controls-note-invalid-profile = El perfil del control no es válido: { $error }
window-controls-note-profile = Perfil: { $file }.
window-controls-note-not-calibrated = «{ $name }» aún no está calibrado.
window-controls-note-saved = Guardado en { $file }.
window-controls-note-not-saved = No se guardó: { $error }.
window-controls-note-disabled = Control desactivado: { $error }.
window-controls-note-lost = «{ $name }» no está conectado.
window-controls-message-connected = Control conectado. { $note } Úselo para volar.
window-controls-message-connected-uncalibrated = Control conectado. { $note } Use el teclado hasta calibrarlo.
window-controls-message-keyboard = { $note } Use el teclado.
window-controls-message-disconnected = «{ $name }» desconectado: palancas centradas y luego sin señal. Pulse una tecla para volar con el teclado.
window-controls-message-reconnected = «{ $name }» conectado de nuevo.
window-controls-the-controller = el control

## Pause

window-paused-title = En pausa
window-paused-text = El reloj está detenido.
window-paused-resume = Continuar (Esc)
window-paused-restart = Reiniciar
window-paused-restart-again = ¿Reiniciar ahora? Pulse otra vez
window-paused-settings = Ajustes y teclas
window-paused-end = Terminar la sesión
window-paused-end-again = ¿Terminar la sesión ahora? Pulse otra vez
window-paused-confirm-title = ¿Terminar la evaluación?
window-paused-confirm-text = El reloj corre. Las tareas que no vuele cuentan como no iniciadas.
window-paused-keep-flying = Seguir volando (Esc)
window-paused-score = Terminar y puntuar el vuelo
window-paused-pause-button = Pausa ({ $pause })
window-paused-end-button = Terminar ({ $pause })
window-paused-no-restart = Una evaluación no se puede reiniciar.

## Result

window-result-lesson-done = Lección terminada
window-result-lesson-steps =
    { $done } de { $steps ->
        [one] { $steps } paso
       *[other] { $steps } pasos
    } de la lección { $done ->
        [one] terminado
       *[other] terminados
    }
window-result-title = Vuelo terminado
window-result-part = { $why }. La puntuación corresponde a la parte que voló.
window-result-advice = Qué mejorar la próxima vez
window-result-overall = total  { $sum } de { $most }
window-result-no-scores = sin puntuación
window-result-not-applicable = no se aplica
window-result-more-unmet = { $count } más: vea el informe
window-result-report = informe
window-result-not-available = no disponible
window-result-moment = Ver en el informe
window-result-moment-number = { $time } ({ $number } de { $count })
window-result-open-report = Abrir el informe
window-result-open-questionnaire = Abrir el cuestionario
window-result-fly-yourself = Volarlo usted: { $job }
window-result-fly-next = Volar a continuación: { $job }
window-result-watch-again = Ver otra vez
window-result-fly-again = Volar otra vez
window-result-choose = Elegir otro trabajo
window-result-after = { $reason } tras { $minutes } min { $seconds } s de vuelo
window-result-not-scored = La sesión no se puntuó. Los datos grabados están en { $folder }
window-result-not-scored-because = La sesión no se puntuó: { $error }

## Defect school

window-school-another = Otra ronda
window-school-next = Siguiente foto
window-school-start-page = Volver al inicio
window-school-stop = Parar (Esc)
window-school-title = Escuela de defectos: foto { $number } de { $count }
window-school-again = Falló una de este tipo. Otra vez:
window-school-question = ¿Qué hay en el centro?
window-school-complete = Escuela de defectos: ronda completa
window-school-right = { $right } de { $asked } correctas al primer intento.
window-school-missed = Falladas: { $kinds }. Pronto las verá otra vez.
window-school-no-more = No había más fotos en esta ronda.
window-school-mastered =
    { $count ->
        [one] Domina { $count } tipo de foto: correcto al menos cuatro veces seguidas.
       *[other] Domina { $count } tipos de foto: correcto al menos cuatro veces seguidas.
    }
window-school-failed = La escuela de defectos ha fallado. Avise a su instructor.
window-school-failed-because = La escuela de defectos ha fallado: { $error }

## Settings

window-settings-title = Ajustes
window-settings-language = Idioma
window-settings-language-about = Idioma de la ventana y de la voz. Los informes también lo usan. Los registros, los archivos de datos y los mensajes del vehículo siguen en inglés.
window-settings-keys = Teclas
window-settings-keys-about = Vea qué hace cada tecla y elija otras.
window-settings-units = Unidades
window-settings-units-about = Unidades en la pantalla. Los informes y archivos son siempre métricos.
window-settings-metric = métricas (m, m/s)
window-settings-us = EE. UU. (ft, mph)
window-settings-text-size = Texto
window-settings-text-size-about = Tamaño de palabras y números. Con texto grande, la pantalla de vuelo omite los valores menos importantes, y las páginas largas se desplazan con Re Pág, Av Pág o la rueda del ratón.
window-settings-picture = Imagen
window-settings-picture-about = Detalle de las imágenes. Auto es alto con tarjeta gráfica y bajo sin ella. El cambio se aplica en el próximo vuelo.
window-settings-auto = auto
window-settings-low = bajo
window-settings-medium = medio
window-settings-high = alto
window-settings-ultra = ultra
window-settings-sound = Sonido
window-settings-sound-about = Todo el sonido encendido o apagado.
window-settings-volume = Volumen
window-settings-volume-about = Volumen de las hélices y de los tonos de aviso.
window-settings-propellers = Hélices
window-settings-propellers-about = Sonido de las hélices. Baja cuando el dron se aleja.
window-settings-warnings = Avisos
window-settings-warnings-about = Un tono para cada aviso. Los avisos siempre aparecen también en la pantalla.
window-settings-speech = Voz
window-settings-speech-about = Los avisos se dicen en voz alta si espeak-ng o spd-say está instalado.
window-settings-restore = Restaurar valores predeterminados
window-settings-restore-about = Restablece todos los ajustes y teclas.
window-settings-back-about = Todos los cambios están guardados.
window-settings-key-unusable = Esta tecla no se puede usar. Pulse otra, o Esc para cancelar.
window-settings-nothing-changed = No se cambió nada.
window-settings-keys-fixed = Las teclas provienen de { $file }. Cámbielas allí.
window-settings-press-key = pulse una tecla
window-settings-restore-keys = Restaurar teclas
window-settings-keys-awaiting = Pulse la tecla nueva. Esc cancela.
window-settings-keys-help = Enter o clic en una fila; luego pulse la tecla nueva. F11 siempre cambia a pantalla completa.
window-settings-key-set = { $key }: { $function }.
window-settings-key-exchanged = { $key }: { $function }. La tecla estaba ocupada: «{ $other }» ahora usa { $other_key }.
window-settings-key-refused = «{ $key }» no se puede usar (permitidas: { $allowed }).
window-settings-keys-restored = Todas las teclas tienen su valor predeterminado.
window-settings-all-restored = Todos los ajustes tienen su valor predeterminado.
window-settings-file-invalid = Se usan los valores predeterminados porque el archivo de ajustes no es válido: { $error }
window-settings-not-saved-invalid = No se guardó porque el archivo de ajustes no es válido: { $error }. Corríjalo o restaure los valores predeterminados.
window-settings-not-saved = No se guardó: { $error }.

## Messages over the flight

window-flight-ghost-assessment = No hay fantasma en una evaluación.
window-flight-map-assessment = No hay mapa en una evaluación.
window-flight-map-off = No hay mapa: esta ventana se inició con --no-map.
window-flight-ghost-expert = No hay fantasma mientras observa al experto.
window-flight-ghost-not-ready = El fantasma aún no está listo: un experto vuela este trabajo en segundo plano. Inténtelo en un minuto.
window-flight-ghost-changed = No hay fantasma de sus propios vuelos: este trabajo ha cambiado desde entonces. Un experto lo vuela en segundo plano. Inténtelo en un minuto.
window-flight-ghost-no-session = No hay fantasma sin una sesión: elija un vuelo en la página de inicio del simulador.
window-flight-ghost = Fantasma: { $words }.
window-flight-ghost-hidden = Fantasma oculto.
window-flight-ghost-best = su mejor vuelo, { $overall } de { $most }
window-flight-ghost-of-expert = el vuelo del experto
window-flight-ghost-of-expert-changed = el vuelo del experto, porque este trabajo ha cambiado desde sus propios vuelos
window-flight-sound-on = Sonido activado.
window-flight-sound-off = Sonido desactivado.
window-flight-no-browser = No se puede abrir un navegador ({ $error }). Escriba la dirección de arriba en un navegador.
window-flight-frozen = Congelado.
window-flight-frozen-keys = Congelado. { $freeze }: continuar    { $rewind }: rebobinar 10 s
window-flight-walk = Inspector: caminando al punto { $place }, { $seconds } s
window-flight-no-places = En este trabajo, el inspector solo tiene un punto.
window-flight-walk-not-here = Solo una ventana que pilota el dron puede enviar al inspector.
window-flight-loading = Cargando: { $what } ... { $pct }%
window-flight-loading-site = sitio y defectos
window-flight-loading-bridges = puentes
window-flight-loading-ground = terreno
window-flight-loading-plants = plantas
window-flight-loading-water = agua
window-flight-loading-graphics = gráficos
window-loading-job = Cargando el trabajo ... { $pct }%
window-loading-monitor = Cargando el sitio y el monitor ... { $pct }%
window-loading-simulator = Iniciando el simulador ... { $pct }%
window-loading-scores = Evaluando la telemetría ... { $pct }%
window-loading-record = Guardando los datos de la sesión ... { $pct }%
window-loading-next-flights = Eligiendo los próximos vuelos ... { $pct }%
window-flight-waiting-seed = Conectado al vehículo. Esperando la semilla de la sesión ...
window-flight-waiting-vehicle = Esperando al vehículo en { $address } ...
window-flight-keys-view = { $swap } vistas    { $map } mapa    { $large_map } mapa grande    { $path } trayectoria    arrastrar o { $look_left } { $look_right } mirar    rueda zoom    { $follow } seguir al dron
window-flight-keys-flight =
    { $arm } armar    { $take_off } despegar    { $up } { $down } subir, bajar    { $turn_left } { $turn_right } girar    { $forward } { $back } { $left } { $right } volar    { $lamp } foco    { $snapshot } foto    { $land } aterrizar
    { $freeze } congelar    { $rewind } rebobinar 10 s    { $walk } caminar
window-flight-keys-short = { $arm } armar    { $take_off } despegar    { $pause } pausa; vea allí las teclas
window-flight-keys-short-view = { $swap } vistas    { $map } mapa    { $follow } seguir al dron

## Texts from `spandrel train`

window-train-form = { $title } (variante { $form })
window-train-level = { $title } (nivel { $level } de { $levels })
window-train-tasks =
    { $count ->
        [one] { $count } tarea
       *[other] { $count } tareas
    }
window-train-bridges =
    { $count ->
        [one] { $count } puente
       *[other] { $count } puentes
    }
window-train-defects =
    { $count ->
        [one] { $count } defecto
       *[other] { $count } defectos
    }
window-train-lesson-progress =
    { $done } de { $steps ->
        [one] { $steps } paso
       *[other] { $steps } pasos
    } de la lección.
window-train-not-in-assessment = No disponible en una evaluación.
window-train-in-flight = Hay un vuelo en curso: termínelo primero.
window-train-no-window = este programa se compiló sin la ventana
window-train-refused = El vuelo no puede empezar: { $error }
window-train-no-briefing = No se pueden imprimir las instrucciones: { $error }
# A flight that an instructor has ordered at this station.
window-ordered = Su instructor ha elegido un vuelo para { $trainee }: { $job } ({ $purpose }).
window-ordered-declined = Ha rechazado el vuelo que eligió su instructor.
