# Warnings and notes of the check of a scenario (`spandrel check` and the web editor).

check-form-incomplete = form { $form }: only { $placed } of { $count } defects could be placed: choose another defect_seed or detection_pct
check-form = form { $form }: predicted detection { $mean } on average ({ $low } to { $high }); { $gradable } of { $defects ->
        [one] 1 defect
       *[other] { $defects } defects
    } { $gradable ->
        [one] counts
       *[other] count
    } for certification
check-standard-level = level { $level } of { $levels }, the standard level: { $settings }
check-level = level { $level } of { $levels }: { $settings }
check-at-level = at level { $level }: { $warning }
check-quantity = bridge { $bridge }: element { $number }, { $name }: { $amount }
check-amount-area = { $reported } sq ft ({ $si } m2)
check-amount-length = { $reported } ft ({ $si } m)
check-amount-each = { $reported } each
check-time = time that the job needs: { $minutes } min for { $path } m of path
check-time-with-defects = time that the job needs: { $minutes } min for { $path } m of path and { $defects ->
        [one] 1 defect
       *[other] { $defects } defects
    }
check-camera = the camera of { $aircraft } reaches { $finest } mm/px at the minimum clearance; cracks narrower than { $crack } mm do not count
check-to-be-certified = to be certified: { $requirement }
check-hidden-defect = defect { $defect } cannot be photographed from within the threshold of any task: move it or a task's path, or make it larger
check-placed-in-forms = the placed defects are the same in all forms
check-placed-at-levels = { $key } has no effect: the placed defects are the same at all levels
check-same-path = task { $task } has the same path as task { $other }
check-unused-temperature = rules.battery_temperature_c has no effect with battery = "paper": set battery = "physical"
check-missing-defects = defects.count = { $wanted }, but only { $placed } could be placed (seed { $seed }): no other spot on a bridge can be photographed from within a task's threshold; move the tasks closer to the structure, extend defects.elements or defects.kinds, or set the count to { $placed }
check-overlap = { $share }% of the path of task { $task } '{ $name }' is within the threshold ({ $threshold } m) of task { $other } '{ $othername }', so that a flight along it counts for both tasks: move the paths apart, or reduce threshold_m
