tutorial-title = Tutorial { $page } of { $pages }: { $title }
tutorial-next = Next page
tutorial-fly = Fly
tutorial-done = Done
tutorial-skip = Skip
tutorial-skip-and-fly = Skip and fly

## The job

tutorial-job-title = the job
tutorial-job-text =
    You are standing on a hillside with a drone. Follow each task's path, photograph each defect once, then return and land on the pad.

    The orange line shows an example flight; the red dots mark its photos.
tutorial-job-pad = take off and land here
tutorial-job-suspension = suspension bridge
tutorial-job-arch = arch bridge
tutorial-job-task = task 4: around the pier

## Two views

tutorial-views-title = two views
tutorial-views-text =
    Your own view from the ground, and the drone camera's view, which is the larger one.

    Press { $swap } to change the layout. Drag with the mouse to look around, scroll to zoom. Press { $follow } to make your view follow the drone again.
tutorial-views-own = your own view
tutorial-views-navigation = navigation display
tutorial-views-camera = the camera's view
tutorial-views-note = The bracket in your view marks the drone and shows its distance. During practice, a map and a side profile of the bridge appear below the navigation display.

## The display

tutorial-display-title = the display
tutorial-display-text =
    Stay below the speed limit during a task. The battery symbol turns from green to yellow (triangle) to red (flashing octagon): return before the battery is empty.

    An assessment has no map.
tutorial-display-speed = speed and its limit
tutorial-display-status = mode, satellites, link
tutorial-display-battery = battery
tutorial-display-readouts = height, distance home, time left
tutorial-display-corners = keep defects inside these corners

## Warnings

tutorial-warnings-title = warnings
tutorial-warnings-text =
    Warnings appear at lower left, the most serious at the bottom. Each has its own shape and, with sound on, its own tone.

    Blue disc: return to the path.
    Yellow triangle: slow down.
    Orange diamond: move away from the structure.
    Red octagon: you hit something.
tutorial-warnings-warnings = warnings
tutorial-warnings-battery = low battery
# What the drone hit in the example.
tutorial-warnings-object = pier

## Defects

tutorial-defects-title = defects
tutorial-defects-text =
    The same defects at 1 m, 3 m, 8 m with one lens. A photo counts if the defect is inside the corner marks, lit, not seen edge-on, and, for a crack, at least half a pixel wide. Fly closer, or zoom ({ $camera_zoom_in }) if the camera can.

    Stains, form lines, sealed cracks, spider webs, and spray paint are not defects. Every photo without a new defect lowers your accuracy.
tutorial-defects-crack = crack
tutorial-defects-spall = spall
tutorial-defects-efflorescence = efflorescence
tutorial-defects-corrosion = corrosion

## Light and scores

tutorial-light-title = light and scores
tutorial-light-text =
    Use the lamp ({ $lamp }) in dark places, as these pictures show.

    Conformity: stay on the path and below the speed limit. Efficiency: return within 15 minutes. Safety: touch nothing; hitting a person or vehicle ends the session. Accuracy: photograph every defect once.
tutorial-light-without = without the lamp
tutorial-light-with = with the lamp
tutorial-light-closer = fly closer to check this
tutorial-light-keys = Release the sticks to hover. Keys: { $arm } arm, { $take_off } take off, { $up } { $down } up and down, { $turn_left } { $turn_right } turn, { $forward } { $back } { $left } { $right } fly, { $lamp } lamp, { $snapshot } photograph, { $gimbal_up } { $gimbal_down } tilt the camera, { $land } land, { $pause } pause.
