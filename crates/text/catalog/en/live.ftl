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
live-contact-none = none
live-contact-bridge = bridge
live-contact-terrain = terrain
live-contact-water = water
live-contact-vehicle = vehicle
live-contact-person = person
live-contact-other = other
live-failed-status = Failed: HTTP status { $status }
live-failed-login = Failed: please log in
live-failed-silent = Failed: no response from the server

## Next step

live-step-of-task = Task { $task }: { $step }
live-step-take-off = Take off
live-step-fly-to-path = fly to the path
live-step-follow-path = follow the path
live-step-fly-home = Fly home
live-step-fly-home-way = Fly home: { $way }
live-step-land = Land on the pad
live-step-over = The session is over
live-step-hold = hold position
live-way-ahead = { $distance } m, ahead
live-way-behind = { $distance } m, behind you
live-way-left = { $distance } m, { $angle } deg left
live-way-right = { $distance } m, { $angle } deg right
live-way-up = { $way }, { $height } m up
live-way-down = { $way }, { $height } m down

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
live-tile-status = HTTP status { $status }
live-tile-login = please log in
live-tile-not-connected = not connected

## Errors

live-error-no-vehicle = no vehicle is configured (--vehicle)
