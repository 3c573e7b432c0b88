# Advertencias y notas de la comprobación de un escenario en el editor web.

check-form-incomplete = variante { $form }: solo se pudieron colocar { $placed } de { $count } defectos: elija otro valor de defect_seed o detection_pct
check-form = variante { $form }: detección prevista del { $mean } en promedio ({ $low } a { $high }); { $gradable } de { $defects ->
        [one] 1 defecto
       *[other] { $defects } defectos
    } { $gradable ->
        [one] cuenta
       *[other] cuentan
    } para la certificación
check-standard-level = nivel { $level } de { $levels }, el nivel estándar: { $settings }
check-level = nivel { $level } de { $levels }: { $settings }
check-at-level = en el nivel { $level }: { $warning }
check-quantity = puente { $bridge }: elemento { $number }, { $name }: { $amount }
check-amount-area = { $si } m² ({ $reported } pies cuadrados)
check-amount-length = { $si } m ({ $reported } pies)
check-amount-each = { $reported } unidades
check-time = tiempo que el trabajo necesita: { $minutes } min para { $path } m de trayectoria
check-time-with-defects = tiempo que el trabajo necesita: { $minutes } min para { $path } m de trayectoria y { $defects ->
        [one] 1 defecto
       *[other] { $defects } defectos
    }
check-camera = la cámara de { $aircraft } alcanza { $finest } mm/px con la separación mínima; las fisuras de menos de { $crack } mm de ancho no cuentan
check-to-be-certified = para la certificación: { $requirement }
check-hidden-defect = el defecto { $defect } no se puede fotografiar desde dentro de la tolerancia de trayectoria de ninguna tarea: muévalo, mueva la trayectoria de una tarea o hágalo más grande
check-placed-in-forms = los defectos colocados son los mismos en todas las variantes
check-placed-at-levels = { $key } no tiene efecto: los defectos colocados son los mismos en todos los niveles
check-same-path = la tarea { $task } tiene la misma trayectoria que la tarea { $other }
check-unused-temperature = rules.battery_temperature_c no tiene efecto con battery = "paper": use battery = "physical"
check-missing-defects = defects.count = { $wanted }, pero solo se pudieron colocar { $placed } (semilla { $seed }): ningún otro lugar de un puente se puede fotografiar desde dentro de la tolerancia de trayectoria de una tarea; acerque las tareas a la estructura, amplíe defects.elements o defects.kinds, o fije la cantidad en { $placed }
check-overlap = el { $share }% de la trayectoria de la tarea { $task } «{ $name }» está dentro de la tolerancia ({ $threshold } m) de la tarea { $other } «{ $othername }», de modo que un vuelo a lo largo de ella cuenta para ambas tareas: separe las trayectorias o reduzca threshold_m
