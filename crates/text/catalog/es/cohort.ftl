## Cohort

cohort-title = Informe de la cohorte
cohort-sections = Secciones
cohort-summary =
    { $trainees ->
        [one] { $trainees } alumno
       *[other] { $trainees } alumnos
    }, { $sessions ->
        [one] { $sessions } sesión
       *[other] { $sessions } sesiones
    } de { $scenarios }.
cohort-certified =
    Certificadas: { $certified } de { $sessions ->
        [one] { $sessions } sesión
       *[other] { $sessions } sesiones
    }.
cohort-group =
    { $trainees ->
        [one] { $trainees } alumno voló
       *[other] { $trainees } alumnos volaron
    } { $repetitions } o más veces.
cohort-section-limitations = Limitaciones
cohort-section-distributions = Puntuaciones de las primeras sesiones
cohort-section-people = Puntuaciones por alumno y tarea
cohort-section-crashes = Colisiones
cohort-section-reliability = Fiabilidad de las medidas
cohort-section-repetitions = Repeticiones
cohort-section-learning = Curvas de aprendizaje
cohort-section-individual = Progreso individual
cohort-section-answers = Respuestas
cohort-section-self-rating = Autoevaluación y puntuación medida
cohort-section-causal = Demanda, tensión, rendimiento
cohort-section-files = Descarga de tablas
cohort-files-note = Las tablas con una fila por alumno no están incluidas porque harían esta página demasiado grande. { $command } escribe { $files }.

## Answers

cohort-answer-strongly-agree = totalmente de acuerdo
cohort-answer-agree = de acuerdo
cohort-answer-neutral = neutral
cohort-answer-disagree = en desacuerdo
cohort-answer-strongly-disagree = totalmente en desacuerdo
cohort-answers-first =
    Todas las primeras sesiones (hasta { $count ->
        [one] { $count } respuesta
       *[other] { $count } respuestas
    })
cohort-answers-first-title = Respuestas de todas las primeras sesiones
cohort-answers-later = Alumnos con sesiones repetidas: repetición { $repetition }
cohort-answers-later-title = Respuestas de la repetición { $repetition }
cohort-self-rating-correlation =
    Correlación de Spearman entre la autoevaluación y la puntuación total: { $correlation }, { $trainees ->
        [one] { $trainees } alumno
       *[other] { $trainees } alumnos
    }.
cohort-self-rating-caption = autoevaluación y puntuación medida
cohort-column-self-rating-scale = autoevaluación (1 a 5)
cohort-column-measured = puntuación medida (%)
cohort-column-trainee = alumno
cohort-column-trainees = alumnos
cohort-column-completion = compleción
cohort-column-certification = certificación

## Causal model

cohort-causal-intro = ¿La demanda aumenta la tensión, la tensión reduce el rendimiento y los avisos en vuelo debilitan el efecto de la demanda sobre la tensión? Estimado con las primeras sesiones de todos los alumnos que respondieron el cuestionario.
cohort-causal-none = No hay estimación: muy pocos alumnos respondieron el cuestionario o sus respuestas no varían. Se recomiendan al menos { $count } alumnos con respuestas completas.
cohort-causal-count =
    { $count ->
        [one] { $count } alumno con respuestas completas.
       *[other] { $count } alumnos con respuestas completas.
    }
cohort-causal-caution = Con menos de { $recommended }, el modelo puede pasar por alto efectos medios. Describe solo a estos alumnos y no se puede generalizar.
cohort-causal-diagram = Diagrama de relaciones; las flechas discontinuas marcan efectos cuyo intervalo de confianza del 95% incluye el cero
cohort-causal-diagram-region = Modelo causal
cohort-causal-diagram-title = Demanda, tensión, rendimiento y avisos
cohort-causal-scales = La demanda, la tensión y los avisos se califican de 1 a 5; el rendimiento es la puntuación total como porcentaje del máximo.
cohort-causal-indirect = Efecto indirecto de una unidad de demanda sobre el rendimiento a través de la tensión, según la utilidad de los avisos, con intervalos de confianza del 95%
cohort-causal-indirect-region = Efectos indirectos
cohort-causal-indirect-axis = % de la puntuación total por unidad de demanda
cohort-causal-indirect-title = Efecto indirecto de la demanda según la utilidad de los avisos
cohort-causal-low = avisos poco útiles
cohort-causal-mean = avisos de utilidad media
cohort-causal-high = avisos muy útiles
cohort-causal-level = { $level } ({ $feedback })
cohort-causal-moderation = moderación: cambio del efecto por unidad de avisos
cohort-causal-effects-caption = efecto indirecto de la demanda sobre el rendimiento a través de la tensión, con intervalos de confianza bootstrap
cohort-causal-coefficients-caption = coeficientes de las dos regresiones
cohort-column-feedback-level = nivel de avisos
cohort-column-feedback = avisos
cohort-column-effect = efecto (%)
cohort-column-ci-lower = límite inferior del IC del 95%
cohort-column-ci-upper = límite superior del IC del 95%
cohort-column-outcome = resultado
cohort-column-term = término
cohort-column-estimate = estimación
cohort-column-standard-error = error estándar
cohort-term-intercept = intersección
cohort-term-demand = demanda
cohort-term-strain = tensión
cohort-term-performance = rendimiento
cohort-term-interaction = demanda × avisos

## First sessions

cohort-histogram = Histograma: { $score }; la línea marca la media
cohort-first-caption = primeras sesiones
cohort-no-tasks = sin tareas
cohort-individuals-caption = primera sesión de cada alumno
cohort-shares = Porcentaje en la trayectoria por alumno y tarea
cohort-shares-figure = Porcentaje de tiempo en la trayectoria
cohort-crashes-count =
    { $count ->
        [one] { $count } colisión
       *[other] { $count } colisiones
    } en las primeras sesiones.
cohort-crashes-by-object = Por objeto
cohort-crashes-by-kind-title = Colisiones por tipo
cohort-crashes-by-task = Por tarea
cohort-crashes-by-task-title = Colisiones por tarea
cohort-crashes-by-trainee = Por alumno
cohort-crashes-by-trainee-title = Colisiones por alumno
cohort-crashes-outside = fuera
cohort-crashes-all = todas
cohort-column-mean = media
cohort-column-sd = desv. est.
cohort-column-min = mín.
cohort-column-median = mediana
cohort-column-max = máx.
cohort-column-skewness = asimetría

## Learning

cohort-learning-mean = media
cohort-learning-fitted = curva ajustada a las medias
cohort-learning-one = un alumno
cohort-learning-none = Ningún alumno ha volado tantas veces todavía.
cohort-learning-figure =
    { $score }, { $count ->
        [one] 1 alumno
       *[other] { $count } alumnos
    }
cohort-learning-note = Cada curva es un ajuste de la ley potencial de la práctica. El anillo marca la predicción para la siguiente repetición. La curva del grupo es más plana que las de los alumnos individuales.
cohort-learning-caption = curvas de aprendizaje del grupo, ajustadas a las medias
cohort-column-first-mean = primera media
cohort-column-last-mean = última media
cohort-individual-too-many = { $count } alumnos volaron más de una vez. Por encima de { $limit } no se muestran individualmente; consulte progress.csv.
cohort-individual =
    { $trainee }, { $count ->
        [one] { $count } vez
       *[other] { $count } veces
    }

## Distributions instead of lists

cohort-pooled-note = { $count } alumnos son demasiados para una lista. Las figuras muestran distribuciones; para los datos individuales, consulte { $file }.
cohort-pooled-tasks = Porcentaje en la trayectoria por tarea (%)
cohort-pooled-tasks-title = Porcentaje en la trayectoria por tarea
cohort-pooled-tasks-caption = porcentaje en la trayectoria por tarea (%), solo de los alumnos que iniciaron la tarea
cohort-pooled-crashes = Alumnos por número de colisiones; la línea marca la media
cohort-pooled-crashes-title = Histograma de colisiones por alumno
cohort-pooled-crashes-caption = alumnos por número de colisiones
cohort-column-crashes-from = colisiones, de
cohort-column-crashes-to = a
cohort-pooled-rating = Puntuación total (% del máximo) por autoevaluación (5 es lo mejor)
cohort-pooled-rating-title = Puntuación medida por autoevaluación
cohort-pooled-rating-caption = puntuación medida por autoevaluación (%)
cohort-contradiction-rated-too-high = valoró su propio desempeño con { $own } de 5, pero obtuvo el { $measured }%, en el cuarto inferior
cohort-contradiction-rated-too-low = valoró su propio desempeño con { $own } de 5, pero obtuvo el { $measured }%, en el cuarto superior
cohort-contradiction-slow = no sintió presión de tiempo, pero voló { $minutes } min, en el cuarto más lento
cohort-contradiction-fast = sintió presión de tiempo, pero voló solo { $minutes } min, en el cuarto más rápido
cohort-pooled-contradictions =
    { $count ->
        [one] { $count } contradicción figura en contradictions.csv.
       *[other] { $count } contradicciones figuran en contradictions.csv.
    }
cohort-column-self-rating = autoevaluación
cohort-column-low-whisker = bigote inferior
cohort-column-high-whisker = bigote superior

## Repetitions

cohort-boxes = Diagramas de caja por repetición: { $score }
cohort-boxes-note = Las cajas muestran los cuartiles y la mediana; las cruces, la media. Los bigotes llegan hasta los valores más extremos dentro de 1.5 rangos intercuartílicos de la caja.
cohort-versus = { $earlier } frente a { $later }
cohort-tests-caption = pruebas t pareadas (repetición posterior menos anterior)
cohort-column-pairs = pares
cohort-column-p-upper = p superior
cohort-column-p-lower = p inferior
cohort-column-p-two = p bilateral
cohort-column-p-holm = p bilateral, Holm
cohort-column-beyond-error = alumnos fuera del error
cohort-homogeneity-caption = primeras sesiones: alumnos con repeticiones frente a todos los demás (puntuaciones bajas / medias / altas)
cohort-column-with-repetitions = con repeticiones
cohort-column-others = otros
cohort-column-chi-squared = chi cuadrado

## Reliability

cohort-reliability-known = Estimado con las primeras { $repetitions } sesiones de cada alumno que voló tantas veces. ICC(2,1) mide la concordancia entre sesiones e ICC(3,1), si el orden de los alumnos se mantiene. Un cambio menor que el cambio mínimo detectable está dentro del error de la medida. Para la media de n alumnos, este límite se divide por la raíz cuadrada de n.
cohort-reliability-unknown = El error de una medida solo se puede estimar si al menos dos alumnos volaron el trabajo más de una vez.
cohort-reliability-caption = fiabilidad de las medidas
cohort-column-measure = medida
cohort-column-sessions = sesiones
cohort-column-ceiling = en el máximo (%)
cohort-column-trainees-repeating = alumnos con repeticiones

## Limitations

cohort-limitations =
    { $count ->
        [one] 1 limitación de estas estadísticas
       *[other] { $count } limitaciones de estas estadísticas
    }
cohort-limit-aided =
    { $count ->
        [one] 1 sesión se congeló o se rebobinó y no se compara
       *[other] { $count } sesiones se congelaron o se rebobinaron y no se comparan
    }
cohort-limit-pooled-forms = se agrupan las variantes { $forms }, como en el artículo de TASBID: un cambio entre repeticiones puede deberse a la dificultad de sus daños
cohort-limit-few-answers =
    demanda, tensión, rendimiento: solo { $count ->
        [one] 1 alumno respondió
       *[other] { $count } alumnos respondieron
    } por completo; con menos de { $recommended }, el modelo puede pasar por alto efectos medianos, por lo que describe solo a estos alumnos y no se puede generalizar
cohort-limit-no-causal-model = demanda, tensión, rendimiento: no se pudo estimar el modelo: { $outcome }: { $reason }
cohort-limit-few-pairs =
    solo { $count ->
        [one] 1 alumno voló
       *[other] { $count } alumnos volaron
    } { $repetitions } veces; con menos de { $recommended }, una prueba pareada puede pasar por alto efectos medianos
cohort-limit-imprecise =
    la fiabilidad de las medidas se basa en { $count ->
        [one] { $count } alumno
       *[other] { $count } alumnos
    }; con menos de { $recommended } es imprecisa
cohort-limit-no-reliability = sin fiabilidad de { $measure }: tiene el mismo valor en todas las sesiones de estos alumnos
cohort-limit-no-comparison = { $score }, repetición { $later } frente a { $earlier }: no es posible ninguna prueba: { $reason }
cohort-limit-no-homogeneity = { $score }: no se puede comparar el grupo con los demás alumnos: { $reason }
cohort-reason-too-few =
    solo { $count ->
        [one] 1 valor
       *[other] { $count } valores
    }; se necesitan al menos { $needed }
cohort-reason-constant = todos los valores son iguales
cohort-reason-collinear = los predictores son colineales en esta muestra
