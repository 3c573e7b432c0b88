job-certification = Zertifizierung: zwei Brücken, 26 Schäden
job-drill-curve-under-arch = Übung: Kurve unter dem Bogen
job-drill-framing = Übung: Bildausschnitt
job-drill-gap = Übung: Engstelle
job-drill-hover = Übung: Schweben
job-drill-lamp = Übung: Scheinwerfer
job-drill-landing = Übung: Landung
job-drill-orbit = Übung: Umkreisen
job-drill-search = Übung: Suchen
job-drill-stand-off = Übung: Abstand
job-drill-straight-line = Übung: gerade Linie
job-first-flight = Lektion: erster Flug
job-girder = Trägerbrücke: Randträger, Trägerzwischenräume, Pfeilerkopfbalken, Lager
job-pilot-study = Pilotstudie: Seite der Fahrbahntafel, Bogenuntersicht, Zwischenraum, Pfeiler
job-practice = Üben an zwei Brücken
job-prestressed = Spannbetonbrücke: Randträger, Trägerzwischenräume, Pfeilerkopfbalken, Lager
job-two-bridges = Zwei Brücken: Seite der Fahrbahntafel, Bogenuntersicht, Zwischenraum, Pfeiler

job-task-curve = Kurve unter dem Bogen
job-task-slab-framing = Seite der Fahrbahntafel, Kamera zur Fahrbahntafel
job-task-gap = Engstelle zwischen Fahrbahntafel und Bogen
job-task-hover = Schweben
job-task-dark-arch = Bogenuntersicht im Dunkeln
job-task-out-and-back = Hin und zurück
job-task-orbit = Umkreisen
job-task-pier-faces = Pfeiler, alle Seiten
job-task-pier-stand-off = Pfeiler in 3 m Abstand
job-task-straight-line = Gerade Linie
job-task-square = Quadrat
job-task-slab = Fahrbahntafel der Bogenbrücke von einer Seite
job-task-arch = Bogenförmige Untersicht
job-task-interlayer = Zwischenraum zwischen Fahrbahntafel und Bogen
job-task-pier = Pfeiler der Hängebrücke nahe am Wasser
job-task-outer-girder = Randträger und Kante der Fahrbahntafel
job-task-girder-bays = Trägerzwischenräume des letzten Feldes
job-task-bearings = Lager auf dem Widerlager am Anfang
job-task-pier-cap = Pfeilerkopfbalken des ersten Pfeilers
job-task-middle-bays = Trägerzwischenräume des mittleren Feldes
job-task-pier-bearings = Lager auf dem zweiten Pfeiler

job-state-open = offen
job-state-overdue = überfällig
job-state-done = erledigt
job-state-done-late = verspätet erledigt

# How a trainee flies a job.
job-how-to-fly = Wählen Sie diesen Auftrag im Simulatorfenster auf der Startseite.
job-how-to-fly-assigned = Auf der Startseite des Simulatorfensters: { $row }
