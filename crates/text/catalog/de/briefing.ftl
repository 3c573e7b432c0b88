briefing-aircraft = Fluggerät
briefing-tasks = Aufgaben
briefing-time = Zeit
briefing-speed = Geschwindigkeit
briefing-defects = Schäden
briefing-wind = Wind
briefing-light = Licht
briefing-sky = Himmel
briefing-traffic = Verkehr

briefing-tasks-and-length = { $tasks }, { $length } m Bahn
briefing-time-needed = etwa { $needed } min nötig, { $allowed } min erlaubt
briefing-speed-limit = { $speed } m/s für die Prüfung, Tempolimit { $limit }
briefing-no-defects = keine
briefing-defects-to-find = { $count } zu finden
briefing-wind-from = { $wind } aus { $bearing }°
briefing-calm = windstill
briefing-sun = { $time } Sonnenzeit, Sonne { $height }° hoch
briefing-no-sun = { $time } Sonnenzeit, keine Sonne
briefing-clouds = zu { $share }% bewölkt
briefing-visibility = Sichtweite { $distance } m
briefing-rain = Regen { $rate } mm/h
briefing-snow = Schnee { $rate } mm/h
briefing-cars = { $count ->
        [one] { $count } Pkw
       *[other] { $count } Pkw
    }
briefing-trucks = { $count ->
        [one] { $count } Lkw
       *[other] { $count } Lkw
    }
briefing-pedestrians = { $count ->
        [one] { $count } Fußgänger
       *[other] { $count } Fußgänger
    }
briefing-drones = { $count ->
        [one] { $count } andere Drohne
       *[other] { $count } andere Drohnen
    }

briefing-hover = an einer Stelle schweben
briefing-place = { $kind ->
        [slab_side] entlang der Kante der Fahrbahntafel
        [arch_bottom] unter dem Bogen
        [interlayer] zwischen Bogen und Fahrbahntafel
        [pier_circle] um den Pfeiler
        [girder_soffit] unter den Trägern
        [bearing_line] an den Lagern entlang
        [pier_cap] um den Pfeilerkopfbalken
        [truss_panel] an der Außenseite des Fachwerks entlang
        [floor_system] unter dem Fahrbahnrost
        [barrel_soffit] unter dem Gewölbe
        [arch_ring] am Gewölbering entlang
        [stay_cable] am Schrägseil entlang
       *[free] entlang der freien Bahn
    }{ $named ->
        [yes] {" "}der Brücke „{ $bridge }“
       *[no] {""}
    }
briefing-place-and-way = { $place }, { $way }
briefing-way-loop = einmal herum, in beliebiger Richtung
briefing-way-back = endet am Anfang
briefing-way-up = von unten nach oben
briefing-way-down = von oben nach unten
briefing-way = von { $from } nach { $to }
briefing-north = Norden
briefing-northeast = Nordosten
briefing-east = Osten
briefing-southeast = Südosten
briefing-south = Süden
briefing-southwest = Südwesten
briefing-west = Westen
briefing-northwest = Nordwesten
briefing-length = { $length } m lang
briefing-height-above = { $height } m über dem Landeplatz
briefing-height-below = { $height } m unter dem Landeplatz
briefing-heights = { $low } bis { $high } m über dem Landeplatz
briefing-stand-off = Abstand { $distance } ± { $tolerance } m
briefing-within = höchstens { $distance } m neben der Bahn
briefing-lamp-needed = Scheinwerfer nötig

briefing-confined = Enge: Bei Aufgabe { $task } ist die Bahn stellenweise nur { $clearance } m vom Bauwerk entfernt.
briefing-darkness = Dunkelheit: Der Scheinwerfer ist bei { $count ->
        [one] Aufgabe { $tasks }
       *[other] den Aufgaben { $tasks }
    } nötig.
briefing-vehicles = Verkehr: { $count ->
        [one] { $count } Fahrzeug
       *[other] { $count } Fahrzeuge
    } auf den Brücken. Halten Sie sich von der Fahrbahn fern.
briefing-people = Personen: { $count ->
        [one] { $count } Fußgänger
       *[other] { $count } Fußgänger
    } auf den Gehwegen. Fliegen Sie nie über Personen.
briefing-other-drones = Andere Drohnen: { $count ->
        [one] { $count } Drohne fliegt hier auf einer festen Bahn und weicht nicht aus. Behalten Sie sie im Blick und halten Sie Abstand.
       *[other] { $count } Drohnen fliegen hier auf festen Bahnen und weichen nicht aus. Behalten Sie sie im Blick und halten Sie Abstand.
    }
briefing-ropes = Seile: { $count ->
        [one] { $count } Seil oder Kabel hängt hier und schwingt
       *[other] { $count } Seile oder Kabel hängen hier und schwingen
    } im Wind. Abstandssensoren sehen sie kaum, achten Sie daher auf die Bilder.
briefing-satellites = GNSS: Das Bauwerk verdeckt Satelliten. Unter dem Überbau kann die Position abdriften.
briefing-compass = Kompass: Stahl verzerrt das Magnetfeld. In der Nähe von Stahlteilen kann die Richtungsanzeige falsch sein und die Position abdriften.
briefing-wakes = Nachlauf: Hinter Pfeilern und Pylonen ist der Wind schwächer, turbulent und schwankend. An den Kanten des Überbaus ändert er sich plötzlich, und darunter ist er schneller.
briefing-cold-battery = Kalter Akku ({ $temperature } °C): Seine Spannung bricht im Steigflug ein, sodass die Drohne weniger Schub hat.
briefing-flow-over-water = Wasser: Optischer Fluss und der Entfernungsmesser nach unten sind über Wasser unzuverlässig, sodass die Position abdriften kann.
briefing-real-sky = GNSS: Brücken verdecken Satelliten, und Wasser und Wände spiegeln deren Signale. An und unter den Brücken können Position und vor allem Höhe falsch sein und springen, wenn Satelliten wieder sichtbar werden.
briefing-radio = Funk: Beton und Stahl schwächen die Signale zwischen Ihnen und der Drohne. Hinter oder unter einer Brücke bricht zuerst das Bild zusammen, dann geht die Steuerung verloren.
briefing-water = Wasser: Teile der Bahnen liegen über Wasser. Bei einer Notlandung dort geht das Fluggerät verloren.
briefing-crash-ends = Eine Kollision beendet die Sitzung.
briefing-wind-force = Wind: eine Kraft von { $force } N.{ $changes ->
        [yes] {" "}Er ändert sich während des Flugs oder ist böig.
       *[no] {""}
    } Rechnen Sie damit, von der Bahn gedrückt zu werden.
briefing-wind-speed = Wind: im Mittel { $speed } m/s.{ $changes ->
        [yes] {" "}Er ändert sich während des Flugs oder ist böig.
       *[no] {""}
    } Rechnen Sie mit Turbulenzen hinter Pfeilern und unter dem Überbau.

briefing-conformity = Bahntreue: Bleiben Sie auf der Bahn und dort unter dem Tempolimit.
briefing-efficiency = Effizienz: Landen Sie, bevor die Zeit um ist und bevor der Akku leer ist.
briefing-safety = Sicherheit: Berühren Sie nichts. Wird eine Person oder ein Fahrzeug getroffen, endet die Sitzung.
briefing-accuracy = Genauigkeit: Fotografieren Sie jeden Schaden einmal, nahe der Bildmitte, und sonst nichts.
briefing-to-be-certified = Für die Zertifizierung: { $requirement }.

briefing-check-risk = Risiko: Ich kenne die Gefahren und breche ab, wenn jemand den Flugbereich betritt.
briefing-check-battery = Akku: voll. Ich lande mit mindestens { $least }% und fliege bei der Akkuwarnung ({ $low }%) zurück.
briefing-check-landing = Landeplatz: { $away } m vom Prüfer entfernt. Eine Landung im Umkreis von { $radius } m gilt als Landung am Landeplatz.
briefing-check-places = Sichtverbindung: Ich behalte die Drohne im Blick. Dafür kann ich zu { $count ->
        [one] einem weiteren Standort
       *[other] { $count } weiteren Standorten
    } auf dem Plan gehen.

# At a terminal, below the briefing.
briefing-confirm = Drücken Sie die Eingabetaste, um die Kontrolle des Einsatzorts zu bestätigen. Danach beginnt der Flug.
