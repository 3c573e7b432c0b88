## What the keys do, on the page of the keys

keys-forward = fly forward
keys-back = fly back
keys-left = fly left
keys-right = fly right
keys-up = climb
keys-down = descend
keys-turn-left = turn left
keys-turn-right = turn right
keys-lamp = lamp
keys-snapshot = photograph
keys-arm = arm
keys-disarm = disarm
keys-take-off = take off
keys-land = land
keys-return = fly home and land
keys-hold = hold the position
keys-position = position mode
keys-gimbal-up = tilt the camera up
keys-gimbal-down = tilt the camera down
keys-camera-zoom-in = zoom the camera in
keys-camera-zoom-out = zoom the camera out
keys-freeze = freeze or continue
keys-rewind = rewind 10 s
keys-stick-response = next stick response
keys-swap = change the layout
keys-map = map on or off
keys-large-map = large map on or off
keys-path = path on or off
keys-ghost = ghost on or off
keys-walk = walk to the next place
keys-follow = follow the drone
keys-look-left = look left
keys-look-right = look right
keys-look-up = look up
keys-look-down = look down
keys-zoom-in = zoom your view in
keys-zoom-out = zoom your view out
keys-pause = pause
keys-restart = restart
keys-sound = sound on or off

## The same in fewer words, beside the sticks on the page of the controller

keys-short-turn-left = turn left
keys-short-turn-right = turn right
keys-short-lamp = lamp
keys-short-snapshot = snapshot
keys-short-arm = arm
keys-short-disarm = disarm
keys-short-take-off = take off
keys-short-land = land
keys-short-return = return
keys-short-hold = hold
keys-short-position = position
keys-short-gimbal-up = gimbal up
keys-short-gimbal-down = gimbal down
keys-short-camera-zoom-in = camera zoom in
keys-short-camera-zoom-out = camera zoom out
keys-short-freeze = freeze
keys-short-rewind = rewind
keys-short-stick-response = stick response
keys-short-walk = walk

## Names of keys

keys-key-escape = Esc
keys-key-page-up = Page up
keys-key-page-down = Page down
keys-key-up = Up
keys-key-down = Down
keys-key-left = Left
keys-key-right = Right
keys-key-space = Space
keys-key-enter = Enter
keys-key-tab = Tab
keys-key-backspace = Backspace
# Keys that can be used.
keys-allowed = one character, or { $names }

## Messages to the pilot

keys-message-arm-first = Arm the motors first
keys-message-arm-first-key = Arm the motors first (key { $key })
keys-message = { $action }: { $result }
keys-message-no-vehicle = no vehicle connected
keys-message-no-response = no response from vehicle
keys-message-temporarily-rejected = temporarily rejected
keys-message-denied = denied
keys-message-no-zoom = this camera cannot zoom
keys-message-unsupported = not supported by this vehicle
keys-message-canceled = canceled
keys-message-failed = failed
keys-message-telemetry = lamp and gimbal telemetry

## Calibration of a controller

keys-wizard-release = Release both sticks (center the throttle if it has no spring), then press Enter.
keys-wizard-rest = Do not touch the sticks ...
keys-wizard-range = Move both sticks through their full range, then press Enter. Axes found: { $found } (at least { $needed } are needed).
keys-wizard-center = Center the sticks ...
keys-wizard-push-left-vertical = Push the LEFT stick fully UP and hold it there.
keys-wizard-push-left-horizontal = Push the LEFT stick fully to the RIGHT and hold it there.
keys-wizard-push-right-vertical = Push the RIGHT stick fully UP and hold it there.
keys-wizard-push-right-horizontal = Push the RIGHT stick fully to the RIGHT and hold it there.
keys-wizard-button-lamp = Press the button for the lamp, or Enter to skip.
keys-wizard-button-snapshot = Press the button for a snapshot, or Enter to skip.
keys-wizard-button-arm = Press the button for arming, or Enter to skip.
keys-wizard-button-take-off = Press the button for takeoff, or Enter to skip.
keys-wizard-button-land = Press the button for landing, or Enter to skip.
keys-wizard-button-gimbal-up = Press the button for camera up, or Enter to skip.
keys-wizard-button-gimbal-down = Press the button for camera down, or Enter to skip.
keys-wizard-done = Done.
keys-wizard-note-button-taken = That button is already assigned.
keys-wizard-note-disconnected = Device disconnected. Reconnect it.
keys-wizard-note-few-axes = Fewer than four axes moved.
keys-wizard-note-range = You did not move that stick through its full range.
keys-wizard-note-axis-taken = That axis is already assigned. Push a different one.
