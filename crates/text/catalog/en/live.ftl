### Web pages about flights in progress.

## Live page

live-title = Live flight
live-waiting = Waiting for a flight at { $address }. This page updates when one starts.
live-no-vehicle = No vehicle configured. Start the server with { $command }.
live-not-connected = Not connected
live-now = Now
live-task = Task
live-step = Next step
live-progress = Path flown
live-time = Time
live-speed = Speed
live-height = Height
live-clearance = Clearance
live-battery = Battery
live-contact = Contact
live-traffic = Traffic
live-wind = Wind at the drone
live-wind-now = { $speed } m/s from { $direction }°
live-wind-calm = { $speed } m/s
live-gnss = GNSS
live-gnss-now =
    { $satellites ->
        [one] { $satellites } satellite
       *[other] { $satellites } satellites
    }
live-gnss-dilution =
    { $satellites ->
        [one] { $satellites } satellite
       *[other] { $satellites } satellites
    }, HDOP { $dilution }
live-gnss-lost =
    No position, { $satellites ->
        [one] { $satellites } satellite
       *[other] { $satellites } satellites
    }
live-compass = Compass
live-compass-now = off by { $degrees }°
live-radio = Radio margin
live-radio-now = control { $control } dB, video { $video } dB
live-hazards = Active hazards
live-warning-control = Control link weak
live-warning-gnss = GNSS lost
live-warning-video = Poor video
live-warning-compass = Compass disturbed
live-cues = Active cues
live-site = Site
live-view-above = From above, north up
live-view-side = { $bridge } from the side
live-view-south = From the south
live-camera-caption = Camera view, updated about once per second
live-camera = Current camera view
live-actions = Instructor actions
live-log = Message log
live-log-label = Messages from the vehicle and the monitor, newest first
live-vehicles = Vehicles
live-all-flights = All flights
live-vehicle-at = Vehicle { $number } · { $address }
live-note = Note for the report
live-add-note = Add note
live-wind-speed = Wind speed (m/s)
live-wind-from = Wind direction (degrees)
live-set-wind = Set wind
live-traffic-note = Closing a bridge stops new traffic; vehicles already on it leave.
live-close-bridges = Close bridges
live-open-bridges = Open bridges
live-practice-note = In practice only. A flight that was frozen, rewound or moved is neither certified nor compared with others.
live-freeze = Freeze
live-continue = Continue
live-rewind = Rewind 10 s
live-move = Move to the start of this task
live-place = Place
live-walk = Send the inspector to this place
live-component = Component
live-unit-gnss = Satellite navigation
live-unit-compass = Compass
live-unit-barometer = Barometer
live-unit-battery = Battery
live-inject = Inject failure
live-clear = Clear failure

## States, shown by the scripts

live-state-frozen = frozen
live-state-armed = live, motors armed
live-state-disarmed = live, motors disarmed
live-state-silent = no telemetry
live-off-path = off path
live-traffic-open = open
live-traffic-closed = closed
live-message-picture = picture { $number }
live-failed-status = Failed: HTTP status { $status }
live-failed-login = Failed: please log in
live-failed-silent = Failed: no response from the server

# Commands of the instructor in the message log, and why the vehicle rejects them.
live-report-note = note: { $note }
live-report-wind = instructor: wind { $speed } m/s from { $from }°
live-report-bridges-open = instructor: the bridges are open to traffic
live-report-bridges-closed = instructor: the bridges are closed to traffic
live-report-freeze = instructor: freeze
live-report-continue = instructor: continue
live-report-rewind = instructor: rewind { $seconds } s
live-report-move = instructor: move to task { $task }
live-report-walk = instructor: the inspector walks to place { $place }
live-report-fails = instructor: { $unit } fails
live-report-restored = instructor: { $unit } restored
live-report-no-response = { $command }: no response
live-report-rejected = { $command }: rejected, { $reason }
live-rejected-not-now = not now
live-rejected-unsupported = the vehicle does not support this command
live-rejected-denied = the vehicle denied this command
live-rejected-failed = the vehicle reported a failure
live-rejected-no-such-parameter = this vehicle has no such parameter
live-rejected-out-of-range = the value is out of range
live-rejected-read-only = the parameter is read-only
live-rejected-invalid-value = the vehicle rejected the value

## Own flight

live-own-title = My flight
live-own-none = No flight in progress. This page updates when your flight starts.
live-own-window = Flight in progress. The camera image is available only in the simulator window.
live-own-flying = Flight in progress.
live-own-status = Not connected: HTTP status { $status }
live-own-login = Not connected: please log in
live-own-caption = Your camera view, updated about once per second
live-own-camera = Your current camera view

## Tiles

live-tiles-title = Live flights
live-tiles-no-vehicle = No vehicle configured. Start the server with { $command }, once for each flight.
live-tile-vehicle = Vehicle { $number }
live-tile-waiting = Waiting for a flight at { $address }
live-tile-camera = Camera view of vehicle { $number }
live-tile-cue = Last cue:
live-tile-no-cue = none yet
live-tile-hazards = Hazards:
live-tile-no-hazard = none
live-tile-status = HTTP status { $status }
live-tile-login = please log in
live-tile-not-connected = not connected

## Errors

live-error-no-vehicle = no vehicle is configured (--vehicle)
