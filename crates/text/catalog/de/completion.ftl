completion-task-done = erledigt ({ $share }% der Bahn)
completion-task-part = teilweise geflogen ({ $share }% der Bahn)
completion-task-not-attempted = nicht begonnen
completion-complete = Vollständig: { $done } von { $tasks ->
        [one] { $tasks } Aufgabe
       *[other] { $tasks } Aufgaben
    }, { $share }% der Bahn
completion-incomplete = Unvollständig: { $done } von { $tasks ->
        [one] { $tasks } Aufgabe
       *[other] { $tasks } Aufgaben
    }, { $share }% der Bahn
completion-not-landed = Unvollständig: { $done } von { $tasks ->
        [one] { $tasks } Aufgabe
       *[other] { $tasks } Aufgaben
    }, { $share }% der Bahn, nicht am Landeplatz gelandet
completion-unknown = Vollständigkeit unbekannt: Importieren Sie diese Sitzung neu
completion-excluded-sessions = { $count ->
        [one] { $count } unvollständige Sitzung nicht gezählt
       *[other] { $count } unvollständige Sitzungen nicht gezählt
    }
completion-included-sessions = { $count ->
        [one] { $count } unvollständige Sitzung mitgezählt
       *[other] { $count } unvollständige Sitzungen mitgezählt
    }
completion-certified = Zertifiziert
completion-not-certified = Nicht zertifiziert
completion-not-certified-why = Nicht zertifiziert: { $unmet }
completion-not-certified-more = Nicht zertifiziert: { $unmet } (und { $more } weitere)

completion-rewound = { $rewinds ->
        [1] einmal zurückgespult
        [2] zweimal zurückgespult
       *[other] { $rewinds }-mal zurückgespult
    }
completion-frozen = { $freezes ->
        [1] einmal eingefroren
        [2] zweimal eingefroren
       *[other] { $freezes }-mal eingefroren
    }
completion-rewound-and-frozen = { $rewound } und { $frozen }
