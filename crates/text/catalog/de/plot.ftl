## Plots

plot-not-applicable = entfällt

## Site drawings

plot-flight-plan = Flug von oben, Norden oben
plot-flight-oblique = Schrägansicht des Flugs, Blick nach Norden
plot-flight-side = Seitenansicht des Flugs an der Brücke „{ $bridge }“
plot-flight-south = Flug von Süden gesehen
plot-defect = Schaden { $defect }: { $outcome }
plot-reference = Sollbahn der Aufgabe { $task }
plot-crash = Kollision ({ $object }) bei { $moment }
plot-session-crash = Sitzung { $session }: Kollision ({ $object }) bei { $moment }
plot-session = Sitzung { $session }
plot-picture = Bild { $picture }: { $verdict }
plot-pad = Landeplatz
plot-inspector = Prüfer
plot-place = Standort { $place } des Prüfers
plot-walk = der Prüfer geht bei { $moment } zu Standort { $place }
plot-truck = Fahrzeug
plot-north = N
plot-both-plan = Beide Flüge von oben, Norden oben
plot-both-side = Seitenansicht beider Flüge an der Brücke „{ $bridge }“
plot-both-south = Beide Flüge von Süden gesehen
plot-job-plan = Einsatzort von oben, Norden oben
plot-job-side = Seitenansicht der Brücke „{ $bridge }“
plot-job-south = Einsatzort von Süden gesehen
plot-site-picture = Bild des Einsatzorts
plot-color-path = Bahn
plot-color-speed = Geschwindigkeit
plot-color-clearance = Abstand zum Bauwerk
plot-legend-between = zwischen den Aufgaben
plot-legend-on-path = auf der Bahn
plot-legend-off-path = während einer Aufgabe neben der Bahn
plot-legend-speed = bis { $speed } m/s
plot-legend-speeding = über dem Tempolimit von { $speed } m/s
plot-legend-far = nichts in der Nähe
plot-legend-over = über { $limit } m
plot-legend-range = { $low } bis { $high } m
plot-legend-under = unter { $limit } m
plot-air = { $caption }. Mittlere Geschwindigkeit der Luft in der Ebene: { $slowest } bis { $fastest } m/s
plot-air-place = { $number }: { $speed } m/s Abweichung vom freien Wind bei { $moment }
plot-legend-air-speed = { $low } bis { $high } m/s
plot-legend-air-arrow = Richtung und Geschwindigkeit in der Ebene
plot-legend-air-turbulence = Turbulenz ab { $share }% des freien Winds
plot-legend-air-flown = nahe der Ebene geflogen
plot-legend-air-flown-far = darüber oder darunter geflogen
plot-legend-air-deck = Ränder des Überbaus

## Statistics

plot-box =
    { $name }: Median { $median }, Quartile { $low } bis { $high }, { $trainees ->
        [one] { $trainees } Trainee
       *[other] { $trainees } Trainees
    }
plot-bin = { $count } von { $low } bis { $high }
plot-mean = Mittelwert { $mean }
plot-predicted = Vorhersage: { $value }
plot-model-demand = Anforderung
plot-model-demand-parts = geistig, körperlich
plot-model-strain = Belastung
plot-model-strain-parts = Zeitdruck, Frust
plot-model-performance = Leistung
plot-model-performance-parts = Gesamtwertung (%)
plot-model-feedback = Rückmeldungen
plot-model-feedback-parts = Nutzen
