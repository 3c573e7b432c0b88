# Warnungen und Hinweise der Prüfung eines Szenarios im Web-Editor.

check-form-incomplete = Variante { $form }: Nur { $placed } von { $count } Schäden fanden Platz: Wählen Sie einen anderen Wert für defect_seed oder detection_pct
check-form = Variante { $form }: Vorhergesagte Entdeckung im Mittel { $mean } ({ $low } bis { $high }); { $gradable } von { $defects ->
        [one] 1 Schaden
       *[other] { $defects } Schäden
    } { $gradable ->
        [one] zählt
       *[other] zählen
    } für die Zertifizierung
check-standard-level = Stufe { $level } von { $levels }, die Standardstufe: { $settings }
check-level = Stufe { $level } von { $levels }: { $settings }
check-at-level = auf Stufe { $level }: { $warning }
check-quantity = Brücke { $bridge }: Element { $number }, { $name }: { $amount }
check-amount-area = { $si } m² ({ $reported } Quadratfuß)
check-amount-length = { $si } m ({ $reported } Fuß)
check-amount-each = { $reported } Stück
check-time = benötigte Zeit: { $minutes } min für { $path } m Bahn
check-time-with-defects = benötigte Zeit: { $minutes } min für { $path } m Bahn und { $defects ->
        [one] 1 Schaden
       *[other] { $defects } Schäden
    }
check-camera = Die Kamera von { $aircraft } erreicht { $finest } mm/px beim Mindestabstand; Risse unter { $crack } mm Breite zählen nicht
check-to-be-certified = für die Zertifizierung: { $requirement }
check-hidden-defect = Schaden { $defect } lässt sich von keiner Aufgabe aus innerhalb ihrer Bahntoleranz fotografieren: Verschieben Sie ihn oder die Bahn einer Aufgabe, oder machen Sie ihn größer
check-placed-in-forms = Die platzierten Schäden sind in allen Varianten gleich
check-placed-at-levels = { $key } wirkt nicht: Die platzierten Schäden sind auf allen Stufen gleich
check-same-path = Aufgabe { $task } hat dieselbe Bahn wie Aufgabe { $other }
check-unused-temperature = rules.battery_temperature_c wirkt nicht mit battery = "paper": Setzen Sie battery = "physical"
check-missing-defects = defects.count = { $wanted }, aber nur { $placed } fanden Platz (Seed { $seed }): Keine andere Stelle einer Brücke lässt sich innerhalb der Bahntoleranz einer Aufgabe fotografieren; verlegen Sie die Aufgaben näher ans Bauwerk, erweitern Sie defects.elements oder defects.kinds, oder setzen Sie die Anzahl auf { $placed }
check-overlap = { $share }% der Bahn von Aufgabe { $task } „{ $name }“ liegen innerhalb der Bahntoleranz ({ $threshold } m) von Aufgabe { $other } „{ $othername }“, sodass ein Flug dort für beide Aufgaben zählt: Rücken Sie die Bahnen auseinander, oder verringern Sie threshold_m
