## Speed, battery, readouts

flight-speed-limit = limit { $limit }
flight-battery-no-data = no battery data
# Where there is little room.
flight-battery-unknown = battery ?
flight-readout-height = height
flight-readout-home = home
flight-readout-gimbal = gimbal
flight-readout-time-left = time left
flight-readout-lamp = lamp
flight-readout-lamp-on = on
flight-readout-lamp-off = off
flight-readout-pictures = pictures
flight-readout-zoom = zoom

## Status

flight-status-no-mode = no mode
flight-status-gnss-count = GNSS { $count }
flight-status-gnss-ok = GNSS ok
flight-status-gnss-lost-count = GNSS lost ({ $count })
flight-status-gnss-lost = GNSS lost
flight-status-gnss-unknown = GNSS ?
flight-status-link-ok = link ok
flight-status-link-lost = LINK LOST { $age }
flight-status-frozen = FROZEN
# Names beside the bars of the radio signals.
flight-status-signal-control = control
flight-status-signal-video = video
flight-status-control-weak = CONTROL WEAK
flight-status-video-weak = VIDEO WEAK

## The next step of the job

flight-step-take-off = Take off
flight-step-return-to-task = Path left: return to task { $task } of { $tasks }
flight-step-fly-to-task = Fly to task { $task } of { $tasks }
# Without a number; not sent by the monitor.
flight-step-fly-to = Fly to
flight-step-inspect-task = Inspect task { $task } of { $tasks }
flight-step-inspect = Inspect
flight-step-fly-home = Fly home
flight-step-land = Land on the pad
flight-step-over = Session over
flight-step-hold-task = Hold position: task { $task } of { $tasks }
flight-step-hold = Hold position:
flight-way-ahead = { $distance }, ahead
flight-way-behind = { $distance }, behind you
flight-way-left = { $distance }, { $angle } left
flight-way-right = { $distance }, { $angle } right
flight-panel-height = height
flight-panel-path = path
flight-panel-stand-off = stand-off
flight-panel-time = time
flight-panel-time-of = { $flown } of { $needed }
# Height of the next place.
flight-height-level = level
flight-height-up = { $height } up
flight-height-down = { $height } down
# Position of the aircraft relative to the path.
flight-deviation-above = { $distance }, { $height } above
flight-deviation-below = { $distance }, { $height } below

## Lessons

flight-lesson-complete = Lesson complete
flight-lesson-step = Step { $step } of { $steps }
flight-lesson-arm = Arm the motors
flight-lesson-take-off = Take off to { $height }
flight-lesson-hover = Hover in the ring for { $time }
flight-lesson-turn = Turn by { $angle }
flight-lesson-fly-path = Fly along the path
flight-lesson-stop-at = Stop in the ring for { $time }
flight-lesson-tilt-down = Tilt the camera down { $angle }
flight-lesson-tilt-up = Tilt the camera up { $angle }
flight-lesson-lamp = Turn the lamp on
flight-lesson-photograph = Photograph a defect
flight-lesson-fly-home = Fly back to the pad
flight-lesson-land = Land on the pad
flight-lesson-done = All steps done
# How a step is done. The variables are names of keys.
flight-how-arm = Press { $arm }. The propellers start to turn.
flight-how-take-off = Press { $take_off }, or hold { $up } to climb.
flight-how-hover = Fly there with { $forward } { $left } { $back } { $right }, { $up } and { $down }, then release all keys.
flight-how-turn = Hold { $turn_left } or { $turn_right }.
flight-how-fly-path = Follow the ribbon through the gates: { $forward } { $left } { $back } { $right }, { $up } and { $down }.
flight-how-stop-at = Release the keys early: the drone needs room to stop.
flight-how-tilt-camera = Press { $gimbal_up } (up) or { $gimbal_down } (down) several times.
flight-how-lamp = Press { $lamp }.
flight-how-photograph = Bring the defect between the corner marks and press { $snapshot }.
flight-how-fly-home = The white square on the compass shows the way.
flight-how-land = Press { $land } above the pad, or hold { $down } until the motors stop.
flight-how-start = Press { $arm } to arm the motors, then { $take_off }.
flight-how-done = You are ready for the first drill.
# What went wrong in a step of a lesson. The monitor sends the English texts.
flight-remark-motors-off = the motors are off: arm them again
flight-remark-left-ring = you left the ring: stay { $time }
flight-remark-no-defect = no defect in the picture

## Warnings

# Names of the warnings. On the display, they are in capitals.
flight-cue-crash = Crash
flight-cue-too-close = Too close
flight-cue-speeding = Too fast
flight-cue-stand-off = Stand-off
flight-cue-off-path = Off path
flight-cue-battery = Battery
# The variable "name" is the name of the warning.
flight-warning-crash = { $name }: { $object }
flight-warning-too-close = { $name }: { $distance }, limit { $limit }
flight-warning-speeding = { $name }: { $speed }, limit { $limit }
flight-warning-stand-off-small = { $name } too small: { $distance }, recommended { $recommended }
flight-warning-stand-off-large = { $name } too large: { $distance }, recommended { $recommended }
flight-warning-off-path = { $name } { $distance }: { $direction }
flight-warning-battery = { $name } { $level }
# Directions back to the path.
flight-directions-two = { $first } and { $second }
flight-directions-three = { $first }, { $second } and { $third }
# What the drone hit.
flight-object-member = bridge member { $name }
flight-object-pad = pad
flight-object-inspector = inspector
flight-object-crew-truck = crew truck
flight-object-car = car { $number }
flight-object-truck = truck { $number }
flight-object-pedestrian = pedestrian { $number }
# Units in spoken warnings.
flight-spoken-meters = meters
flight-spoken-feet = feet
flight-spoken-miles-per-hour = miles per hour
flight-spoken-meters-per-second = meters per second
flight-spoken-percent = percent
# Spoken alarms. The letters of abbreviations are spoken one by one.
flight-spoken-link-lost = Link lost
flight-spoken-gnss-lost = G N S S lost
flight-spoken-control-weak = Control link weak
flight-spoken-video-weak = Video link weak

## Instruments and markers

flight-instruments-obstacle = obstacle
flight-instruments-none-near = none near
flight-compass-north = N
flight-compass-east = E
flight-compass-south = S
flight-compass-west = W
# Distance of a drone behind an object.
flight-marker-hidden = { $distance }, hidden

## Messages over the flight

flight-message-task = Task { $task }: { $words }
flight-message-fly-to-path = Task { $task }: fly to the path
flight-message-follow-path = Task { $task }: follow the path
flight-message-hold = Task { $task }: hold position
flight-message-fly-home = Fly home: { $words }
flight-message-return = Return to task { $task }: { $words }
flight-message-first = First: { $words }
flight-detour-out-from-under = fly out from under the bridge first
flight-detour-climb = climb first
flight-detour-descend = descend first
flight-detour-around = fly around the obstacle first
flight-message-session-over = The session is over
flight-message-lesson = Lesson: { $words }
flight-message-lesson-step = Lesson: { $step }/{ $steps } { $words }
flight-message-certified = Session over: { $points } points, certified
flight-message-not-certified = Session over: { $points } points, not certified
flight-message-nothing-to-score = Session over: nothing to score
# Height in the texts about the way.
flight-message-way-up = { $way }, { $height } up
flight-message-way-down = { $way }, { $height } down
