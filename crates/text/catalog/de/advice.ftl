advice-lesson = Die Wertung einer Lektion zählt nicht. Wenn Sie jeden Schritt erledigt haben, fliegen Sie die erste Übung.
advice-nothing-to-correct = Nichts zu verbessern: Fliegen Sie den nächsten Auftrag.
advice-certified = Sie sind zertifiziert, und kein einzelner Fehler fällt auf.
advice-not-certified = Kein einzelner Fehler fällt auf, aber Sie sind noch nicht zertifiziert: { $unmet }.
advice-fly-again = Kein einzelner Fehler fällt auf: Fliegen Sie den Auftrag noch einmal.
advice-not-finished = Kein einzelner Fehler fällt auf, aber der Auftrag ist nicht beendet: Fliegen Sie ihn bis zum Ende.

advice-and = { $first } und { $last }
advice-when = { $place ->
        [task] bei Aufgabe { $tasks } für
        [tasks] bei den Aufgaben { $tasks } für
       *[none] für
    } { $time }{ $stretches ->
        [one] {" "}ab { $from }
       *[other] , am längsten ab { $from }
    }

advice-off-path = Sie haben die Bahn verlassen, { $when }, bis zu { $most } m weit: Kehren Sie zurück, bevor Sie weiterfliegen.
advice-drifted-up = Sie sind im Mittel { $mean } m über die Bahn geraten, { $when }: Halten Sie die Höhe.
advice-drifted-down = Sie sind im Mittel { $mean } m unter die Bahn geraten, { $when }: Halten Sie die Höhe.
advice-beside-path = Sie sind { $mean } m neben der Bahn geflogen, { $when }: Fliegen Sie auf der Bahn selbst.
advice-too-far = Sie sind { $mean } m zu weit weg { $surface ->
        [slab_side] von der Fahrbahntafel
        [arch_bottom] vom Bogen
        [pier_circle] vom Pfeiler
        [girder_soffit] von den Trägern
        [pier_cap] vom Pfeilerkopfbalken
        [truss_panel] vom Fachwerk
        [floor_system] vom Fahrbahnrost
        [barrel_soffit] vom Gewölbe
        [arch_ring] vom Gewölbering
        [stay_cable] von den Schrägseilen
       *[structure] vom Bauwerk
    } geflogen, { $when }: Fliegen Sie näher heran.
advice-too-close = Sie sind { $mean } m zu nah { $surface ->
        [slab_side] an der Fahrbahntafel
        [arch_bottom] am Bogen
        [pier_circle] am Pfeiler
        [girder_soffit] an den Trägern
        [pier_cap] am Pfeilerkopfbalken
        [truss_panel] am Fachwerk
        [floor_system] am Fahrbahnrost
        [barrel_soffit] am Gewölbe
        [arch_ring] am Gewölbering
        [stay_cable] an den Schrägseilen
       *[structure] am Bauwerk
    } geflogen, { $when }: Vergrößern Sie den Abstand.
advice-uneven-distance = Ihr Abstand { $surface ->
        [slab_side] von der Fahrbahntafel
        [arch_bottom] vom Bogen
        [pier_circle] vom Pfeiler
        [girder_soffit] von den Trägern
        [pier_cap] vom Pfeilerkopfbalken
        [truss_panel] vom Fachwerk
        [floor_system] vom Fahrbahnrost
        [barrel_soffit] vom Gewölbe
        [arch_ring] vom Gewölbering
        [stay_cable] von den Schrägseilen
       *[structure] vom Bauwerk
    } schwankte und wich bei { $at } um { $most } m ab: Folgen Sie der Form der Bahn.
advice-uneven-height = Ihre Höhe über der Bahn schwankte{ $place ->
        [task] {" "}bei Aufgabe { $tasks }
        [tasks] {" "}bei den Aufgaben { $tasks }
       *[none] {""}
    }, am stärksten bei { $at } um { $most } m: Halten Sie die Höhe.
advice-too-high = Sie sind { $mean } m über der Bahn geflogen, { $when }: Sinken Sie auf die Bahn.
advice-too-low = Sie sind { $mean } m unter der Bahn geflogen, { $when }: Steigen Sie auf die Bahn.
advice-speeding = Sie sind{ $place ->
        [task] {" "}bei Aufgabe { $tasks }
        [tasks] {" "}bei den Aufgaben { $tasks }
       *[none] {""}
    } bis zu { $most } m/s geflogen, { $when } über dem Tempolimit von { $limit } m/s: Fliegen Sie langsamer.
advice-low-clearance = Sie waren weniger als { $limit } m vom Bauwerk entfernt, { $when }, im Minimum { $least } m: Halten Sie Abstand.
advice-stick-reversals = Sie haben die Steuerknüppel{ $place ->
        [task] {" "}bei Aufgabe { $tasks }
        [tasks] {" "}bei den Aufgaben { $tasks }
       *[none] {""}
    } bis zu { $most }-mal pro Minute umgesteuert, am häufigsten ab { $at }: Korrigieren Sie sanft und in kleinen Schritten.
advice-stick-jumps = Sie haben die Steuerknüppel{ $place ->
        [task] {" "}bei Aufgabe { $tasks }
        [tasks] {" "}bei den Aufgaben { $tasks }
       *[none] {""}
    } bis zu { $most }-mal pro Minute ruckartig bewegt, am häufigsten ab { $at }: Bewegen Sie sie gleichmäßig.
advice-yaw-reversals = Sie haben den Gierknüppel{ $place ->
        [task] {" "}bei Aufgabe { $tasks }
        [tasks] {" "}bei den Aufgaben { $tasks }
       *[none] {""}
    } bis zu { $most }-mal pro Minute umgesteuert, am häufigsten ab { $at }: Halten Sie die Richtung.

advice-framing = Ihre Kamera zeigte bis zu { $most } Grad { $surface ->
        [slab_side] von der Fahrbahntafel
        [arch_bottom] vom Bogen
        [pier_circle] vom Pfeiler
        [girder_soffit] von den Trägern
        [pier_cap] vom Pfeilerkopfbalken
        [truss_panel] vom Fachwerk
        [floor_system] vom Fahrbahnrost
        [barrel_soffit] vom Gewölbe
        [arch_ring] vom Gewölbering
        [stay_cable] von den Schrägseilen
       *[structure] vom Bauwerk
    } weg, { $when }: Drehen Sie die Nase dorthin.
advice-lamp-off = Ihr Scheinwerfer war im Dunkeln aus, { $when }: Schalten Sie ihn im Schatten ein.

advice-crash-times = bei { $times }
advice-crash-first-and-hardest = zuerst bei { $first }, am heftigsten bei { $hardest } ({ $speed } m/s)
advice-crash =
    Sie haben { $count ->
        [1] einmal
        [2] zweimal
       *[other] { $count }-mal
    } { $object ->
        [bridge] die Brücke
        [terrain] den Boden
        [water] das Wasser
        [vehicle] ein Fahrzeug
        [person] eine Person
        [other] ein Hindernis
        [none] nichts
       *[several] Hindernisse
    } getroffen{ $place ->
        [task] , bei Aufgabe { $tasks }
        [tasks] , bei den Aufgaben { $tasks }
        [between] , zwischen den Aufgaben
       *[none] {""}
    }, { $when }: { $remedy ->
        [altitude] Halten Sie die Höhe
        [people] Halten Sie sich von Personen und Verkehr fern
       *[distance] Halten Sie Abstand
    }.

advice-missed-in-view = Sie haben { $missed } von { $all } { $kind ->
        [severe] schweren Schäden
        [hidden] Schäden, die von der Bahn abgewandt sind,
        [cracks] Rissen
       *[all] Schäden
    } nicht fotografiert; Schaden { $defect } war bei { $at } deutlich zu sehen: Halten Sie an und machen Sie ein Bild.
advice-missed-nearest = Sie haben { $missed } von { $all } { $kind ->
        [severe] schweren Schäden
        [hidden] Schäden, die von der Bahn abgewandt sind,
        [cracks] Rissen
       *[all] Schäden
    } nicht fotografiert; bei { $at } hätten Sie Schaden { $defect } am ehesten gesehen: Suchen Sie dort langsam.
advice-passed-in-view = Sie sind an { $count ->
        [one] einem deutlich sichtbaren Schaden
       *[other] { $count } deutlich sichtbaren Schäden
    } ohne Bild vorbeigeflogen, am längsten { $seconds } s lang bei { $at }: Fliegen Sie dort langsamer oder näher.
advice-picture-failed = { $count ->
        [one] Ihr Bild eines Schadens war
       *[other] Ihre Bilder von { $count } Schäden waren
    } { $why ->
        [dark] zu dunkel
        [oblique] zu schräg aufgenommen
        [small] aus zu großer Entfernung aufgenommen
        [thin] für einen feinen Riss aus zu großer Entfernung aufgenommen
       *[other] ungenügend ({ $reason })
    }, zuerst bei { $at }: { $why ->
        [dark] Schalten Sie den Scheinwerfer ein
        [oblique] Richten Sie die Nase gerade auf die Oberfläche
        [small] Fliegen Sie näher heran
        [thin] Fliegen Sie näher heran
       *[other] Beheben Sie das vor der Aufnahme
    }.
advice-picture-poor =
    { $found ->
        [one] Bei dem gefundenen Schaden
       *[other] Bei { $count } der { $found } gefundenen Schäden
    } ist Ihr Bild { $why ->
        [blur] durch Bewegung unscharf
        [coarse] zu gering aufgelöst
        [oblique] zu schräg aufgenommen
       *[other] nicht gut genug
    }, zuerst bei { $at }: { $why ->
        [blur] Halten Sie vor der Aufnahme an
        [coarse] Fliegen Sie näher heran
        [oblique] Richten Sie die Nase gerade auf die Oberfläche
       *[other] Lesen Sie im Bericht, was bei jedem Bild fehlt
    }.
advice-no-pictures = Sie haben keinen Schaden fotografiert (vorhanden: { $count }); die beste Gelegenheit war bei { $at }: Fotografieren Sie jeden Schaden.
advice-none-found =
    Sie haben { $all ->
        [one] den Schaden
       *[other] keinen der { $all } Schäden
    }{ $place ->
        [task] {" "}bei Aufgabe { $tasks }
        [tasks] {" "}bei den Aufgaben { $tasks }
       *[none] {""}
    } { $all ->
        [one] nicht fotografiert
       *[other] fotografiert
    }; bei { $at } waren Sie einem Blick auf Schaden { $defect } am nächsten: Suchen Sie jede Aufgabe bis zum Ende ab.
advice-moving-pictures =
    { $taken ->
        [one] Ihr einziges Bild haben Sie in der Bewegung aufgenommen, bei
       *[other] { $count ->
            [one] Eines
           *[other] { $count }
        } Ihrer { $taken } Bilder haben Sie in der Bewegung aufgenommen, { $count ->
            [one] bei
           *[other] zuerst bei
        }
    } { $at }: Halten Sie vor jedem Bild an.
advice-drifting-pictures =
    { $taken ->
        [one] Bei Ihrem einzigen Bild driftete die Drohne, bei
       *[other] Bei { $count ->
            [one] einem
           *[other] { $count }
        } Ihrer { $taken } Bilder driftete die Drohne, { $count ->
            [one] bei
           *[other] zuerst bei
        }
    } { $at }: Lassen Sie sie vor jedem Bild zur Ruhe kommen.
advice-turning-pictures =
    { $taken ->
        [one] Bei Ihrem einzigen Bild haben Sie gedreht, bei
       *[other] Bei { $count ->
            [one] einem
           *[other] { $count }
        } Ihrer { $taken } Bilder haben Sie gedreht, { $count ->
            [one] bei
           *[other] zuerst bei
        }
    } { $at }: Halten Sie die Richtung, bis das Bild aufgenommen ist.
advice-unlit-pictures =
    { $count ->
        [one] Bei einem Bild{ $place ->
        [task] {" "}von Aufgabe { $tasks }
        [tasks] {" "}der Aufgaben { $tasks }
       *[none] {""}
    } war der Scheinwerfer aus, bei
       *[other] Bei { $count } Bildern{ $place ->
        [task] {" "}von Aufgabe { $tasks }
        [tasks] {" "}der Aufgaben { $tasks }
       *[none] {""}
    } war der Scheinwerfer aus, zuerst bei
    } { $at }: Schalten Sie ihn vor dem Bild ein.
advice-pictures-of-nothing = { $taken ->
        [one] Auf Ihrem einzigen Bild, bei { $at }, ist kein neuer Schaden zu sehen
       *[other] Auf { $count } Ihrer { $taken } Bilder ist kein neuer Schaden zu sehen, { $count ->
            [one] bei
           *[other] zuerst bei
        } { $at }
    }: Schauen Sie erst, dann machen Sie das Bild.

advice-not-attempted = Sie haben { $place ->
        [task] Aufgabe { $tasks }
        [tasks] die Aufgaben { $tasks }
       *[none] die Aufgabe
    } nicht geflogen: Der Flug endete bei { $at }.
advice-not-covered = Sie haben nur { $shares } { $place ->
        [task] der Bahn von Aufgabe { $tasks } geflogen und sie
        [tasks] der Bahnen der Aufgaben { $tasks } geflogen und Aufgabe { $least }
       *[none] der Bahn geflogen und sie
    } bei { $at } verlassen: Fliegen Sie jede Bahn bis zum Ende.
advice-overtime = Sie sind { $flown } geflogen, { $over } länger als für die volle Punktzahl erlaubt; die Zeit war bei { $at } um: Planen Sie die Reihenfolge der Aufgaben.
advice-slow = Sie sind { $flown } geflogen; bei Inspektionsgeschwindigkeit dauert dieser Auftrag { $needed }. Ab { $at } lagen Sie darüber: Verweilen Sie nicht, wo nichts zu sehen ist.
advice-landing = Ihre Landung dauerte { $took } ab dem letzten Anflug bei { $at }: Sinken Sie stetig und setzen Sie auf.
advice-not-landed = Ihr Flug endete bei { $at }, { $away } m vom Landeplatz: Fliegen Sie zurück und landen Sie dort.
advice-battery-low = Am Ende waren noch { $left }% Akku übrig; die Reserve von { $reserve }% war bei { $at } erreicht: Kehren Sie früher um.
advice-time-up = Ihre Zeit war bei { $at } um, { $away } m vom Landeplatz: Kehren Sie früher um.
advice-battery-empty = Ihr Akku war bei { $at } leer, { $away } m vom Landeplatz: Kehren Sie früher um.
