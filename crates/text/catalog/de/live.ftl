live-title = Laufender Flug
live-waiting = Warten auf einen Flug unter { $address }. Diese Seite aktualisiert sich, sobald einer beginnt.
live-no-vehicle = Kein Fluggerät eingerichtet. Starten Sie den Server mit { $command }.
live-not-connected = Nicht verbunden
live-now = Jetzt
live-task = Aufgabe
live-step = Nächster Schritt
live-progress = Geflogene Bahn
live-time = Zeit
live-speed = Geschwindigkeit
live-height = Höhe
live-clearance = Abstand
live-battery = Akku
live-contact = Berührung
live-traffic = Verkehr
live-wind = Wind an der Drohne
live-wind-now = { $speed } m/s aus { $direction }°
live-wind-calm = { $speed } m/s
live-gnss = GNSS
live-gnss-now =
    { $satellites ->
        [one] { $satellites } Satellit
       *[other] { $satellites } Satelliten
    }
live-gnss-dilution =
    { $satellites ->
        [one] { $satellites } Satellit
       *[other] { $satellites } Satelliten
    }, HDOP { $dilution }
live-gnss-lost =
    Keine Position, { $satellites ->
        [one] { $satellites } Satellit
       *[other] { $satellites } Satelliten
    }
live-compass = Kompass
live-compass-now = Abweichung { $degrees }°
live-radio = Funkreserve
live-radio-now = Steuerung { $control } dB, Video { $video } dB
live-hazards = Aktive Gefahren
live-warning-control = Steuerverbindung schwach
live-warning-gnss = GNSS verloren
live-warning-video = Video schlecht
live-warning-compass = Kompass gestört
live-cues = Aktive Warnungen
live-site = Einsatzort
live-view-above = Von oben, Norden oben
live-view-side = { $bridge } von der Seite
live-view-south = Von Süden
live-camera-caption = Kamerabild, etwa einmal pro Sekunde aktualisiert
live-camera = Aktuelles Kamerabild
live-actions = Aktionen für Ausbilder
live-log = Meldungen
live-log-label = Meldungen des Fluggeräts und des Monitors, neueste zuerst
live-vehicles = Fluggeräte
live-all-flights = Alle Flüge
live-vehicle-at = Fluggerät { $number } · { $address }
live-note = Notiz für den Bericht
live-add-note = Notiz hinzufügen
live-wind-speed = Windgeschwindigkeit (m/s)
live-wind-from = Windrichtung (Grad)
live-set-wind = Wind setzen
live-traffic-note = Eine Sperrung hält neuen Verkehr an; Fahrzeuge auf der Brücke fahren weiter.
live-close-bridges = Brücken sperren
live-open-bridges = Brücken freigeben
live-practice-note = Nur bei Übungsflügen. Ein Flug, der eingefroren, zurückgespult oder versetzt wurde, wird weder zertifiziert noch mit anderen verglichen.
live-freeze = Einfrieren
live-continue = Fortsetzen
live-rewind = 10 s zurückspulen
live-move = An den Anfang dieser Aufgabe versetzen
live-place = Standort
live-walk = Prüfer zu diesem Standort schicken
live-component = Komponente
live-unit-gnss = Satellitennavigation
live-unit-compass = Kompass
live-unit-barometer = Barometer
live-unit-battery = Akku
live-inject = Ausfall auslösen
live-clear = Ausfall aufheben

live-state-frozen = eingefroren
live-state-armed = live, Motoren an
live-state-disarmed = live, Motoren aus
live-state-silent = keine Telemetrie
live-off-path = neben der Bahn
live-traffic-open = frei
live-traffic-closed = gesperrt
live-message-picture = Bild { $number }
live-failed-status = Fehlgeschlagen: HTTP-Status { $status }
live-failed-login = Fehlgeschlagen: Bitte melden Sie sich an
live-failed-silent = Fehlgeschlagen: keine Antwort vom Server

# Commands of the instructor in the message log, and why the vehicle rejects them.
live-report-note = Notiz: { $note }
live-report-wind = Ausbilder: Wind { $speed } m/s aus { $from }°
live-report-bridges-open = Ausbilder: Brücken für den Verkehr geöffnet
live-report-bridges-closed = Ausbilder: Brücken für den Verkehr gesperrt
live-report-freeze = Ausbilder: eingefroren
live-report-continue = Ausbilder: fortgesetzt
live-report-rewind = Ausbilder: { $seconds } s zurückgespult
live-report-move = Ausbilder: zu Aufgabe { $task } versetzt
live-report-walk = Ausbilder: der Prüfer geht zu Standort { $place }
live-report-fails = Ausbilder: { $unit } fällt aus
live-report-restored = Ausbilder: { $unit } wiederhergestellt
live-report-no-response = { $command }: keine Antwort
live-report-rejected = { $command }: abgelehnt, { $reason }
live-rejected-not-now = nicht jetzt
live-rejected-unsupported = das Fluggerät unterstützt diesen Befehl nicht
live-rejected-denied = das Fluggerät hat diesen Befehl verweigert
live-rejected-failed = das Fluggerät hat einen Fehler gemeldet
live-rejected-no-such-parameter = dieses Fluggerät hat keinen solchen Parameter
live-rejected-out-of-range = der Wert liegt außerhalb des zulässigen Bereichs
live-rejected-read-only = der Parameter ist schreibgeschützt
live-rejected-invalid-value = das Fluggerät hat den Wert abgelehnt

live-own-title = Mein Flug
live-own-none = Kein laufender Flug. Diese Seite aktualisiert sich, sobald Ihr Flug beginnt.
live-own-window = Flug läuft. Das Kamerabild ist nur im Simulatorfenster verfügbar.
live-own-flying = Flug läuft.
live-own-status = Nicht verbunden: HTTP-Status { $status }
live-own-login = Nicht verbunden: Bitte melden Sie sich an
live-own-caption = Ihr Kamerabild, etwa einmal pro Sekunde aktualisiert
live-own-camera = Ihr aktuelles Kamerabild

live-tiles-title = Laufende Flüge
live-tiles-no-vehicle = Kein Fluggerät eingerichtet. Starten Sie den Server mit { $command }, einmal je Flug.
live-tile-vehicle = Fluggerät { $number }
live-tile-waiting = Warten auf einen Flug unter { $address }
live-tile-camera = Kamerabild von Fluggerät { $number }
live-tile-cue = Letzte Warnung:
live-tile-no-cue = noch keine
live-tile-hazards = Gefahren:
live-tile-no-hazard = keine
live-tile-status = HTTP-Status { $status }
live-tile-login = bitte anmelden
live-tile-not-connected = nicht verbunden

live-error-no-vehicle = Kein Fluggerät ist eingerichtet (--vehicle).
