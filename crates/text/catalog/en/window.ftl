## All pages

window-back = Back (Esc)
window-help = Up/down select, left/right change, Enter confirm; or click.
window-help-dialog = Up/down select, Enter confirm; or click.
# In every language, so that everybody finds it.
window-language = Language / Sprache / Idioma
window-on = on
window-off = off

## Start page

window-start-title = Spandrel: inspect a bridge with a drone
window-start-trainee = Trainee
window-start-job = Job
window-start-aircraft = Aircraft
window-start-purpose = Purpose
window-start-check-controller = Next: check controller
window-start-watch-expert = Watch an expert fly this job
window-start-tutorial = Read the tutorial
window-start-school = Defect school: recognize defects in pictures
window-start-settings = Settings: keys, units, text size, sound
window-start-quit = Quit
window-start-recommended = Recommended: { $job }
window-start-assigned = Assigned, due { $date }: { $job }
window-start-enter-name = Enter a pseudonym, not a real name.
window-start-no-sessions = No sessions yet. To change the pseudonym, type another one.
window-start-from-last-session = This recommendation follows from your last session alone. With the web pages on, it considers all of them.
window-start-sessions =
    { $count ->
        [one] One session so far.
       *[other] { $count } sessions so far.
    }
window-start-tutorial-first = Your first practice starts with a tutorial.
window-start-last-flight = Last flight: { $words }
window-start-about-practice = You can pause and restart; the map shows the paths.
window-start-about-assessment = One attempt: no pause, restart, or map.
window-start-web = View sessions in browser
window-start-name-characters = Use letters, digits, '-' and '_'; start with a letter or digit.
window-start-name-length = At most { $count } characters.
window-start-name-first = Enter a pseudonym first.

## Waiting

window-waiting-simulator = Starting simulator ...
window-waiting-scoring = Scoring flight ...
window-waiting-pictures = Preparing pictures ...
window-waiting-briefing = Preparing briefing ...

## Briefing

window-briefing-title = Briefing: { $job }
window-briefing-acknowledge = I have read this and checked the site: fly
window-briefing-print = Print the briefing
window-briefing-site-check = Site check
window-briefing-tasks = Tasks, in this order
window-briefing-conditions = Conditions
window-briefing-hazards = Hazards
window-briefing-counts = What counts
window-briefing-notes = From your instructor
window-briefing-map = Map
window-briefing-side = Bridge '{ $bridge }' from the side
window-briefing-from-south = From the south

## Controller

window-controls-title = Check the controller
window-controls-none = No controller found. Use the keyboard.
window-controls-lost = { $name } not connected: using keyboard
window-controls-calibrated = { $name }, calibrated
window-controls-not-calibrated = { $name }, not calibrated: using keyboard
window-controls-fly = Start flight
window-controls-calibrate = Calibrate
window-controls-calibrate-again = Calibrate again
window-controls-search = Search for controller
window-controls-mode = Stick mode
window-controls-dead-band = Dead band
window-controls-expo = Expo
window-controls-continue = Continue (Enter)
window-controls-cancel = Cancel (Esc)
window-controls-press-keys = Press the flight keys; the dots should follow. To continue, use Tab and Enter or the mouse.
window-controls-move-sticks = Move the sticks; the dots should follow, return to the center, and reach all edges.
window-controls-left-stick = left stick
window-controls-right-stick = right stick
window-controls-vertical = vertical: { $words }
window-controls-horizontal = horizontal: { $words }
window-controls-pitch = forward, back
window-controls-throttle = up, down
window-controls-roll = left, right
window-controls-yaw = turn
window-controls-axis = axis { $number }
window-controls-no-axis = No axis has moved yet.
# Notes about the controller.
window-controls-note-none = No gamepad or transmitter is connected.
window-controls-note-no-match = No device matches '{ $wanted }' (connected: { $connected }).
window-controls-note-ambiguous = More than one device matches ({ $connected }). Disconnect all but one.
window-controls-note-no-access = Controllers cannot be used on this computer: { $error }
window-controls-note-unsupported = This program was built without support for controllers.
window-controls-note-invalid-profile = The controller's profile is invalid: { $error }
window-controls-note-profile = Profile: { $file }.
window-controls-note-not-calibrated = '{ $name }' is not calibrated yet.
window-controls-note-saved = Saved in { $file }.
window-controls-note-not-saved = Not saved: { $error }.
window-controls-note-disabled = Controller disabled: { $error }.
window-controls-note-lost = '{ $name }' is not connected.
# Messages in flight. The variable "note" is a sentence about the controller.
window-controls-message-connected = Controller connected. { $note } Use it to fly.
window-controls-message-connected-uncalibrated = Controller connected. { $note } Use the keyboard until it is calibrated.
window-controls-message-keyboard = { $note } Use the keyboard.
window-controls-message-disconnected = '{ $name }' disconnected: stick input centered, then stopped. Press a key to fly with the keyboard.
window-controls-message-reconnected = '{ $name }' reconnected.
window-controls-the-controller = the controller

## Pause

window-paused-title = Paused
window-paused-text = The clock is stopped.
window-paused-resume = Resume (Esc)
window-paused-restart = Restart
window-paused-restart-again = Restart now? Press again
window-paused-settings = Settings and keys
window-paused-end = End session
window-paused-end-again = End session now? Press again
window-paused-confirm-title = End the assessment?
window-paused-confirm-text = The clock is running. Tasks you don't fly count as not attempted.
window-paused-keep-flying = Keep flying (Esc)
window-paused-score = End and score flight
window-paused-pause-button = Pause ({ $pause })
window-paused-end-button = End ({ $pause })
window-paused-no-restart = An assessment cannot be restarted.

## Result

window-result-lesson-done = Lesson done
window-result-lesson-steps =
    { $done } of { $steps ->
        [one] { $steps } step
       *[other] { $steps } steps
    } of the lesson done
window-result-title = Flight ended
window-result-part = { $why }. The scores cover the part you flew.
window-result-advice = Do better next time
window-result-overall = overall  { $sum } of { $most }
window-result-no-scores = no scores
window-result-not-applicable = not applicable
window-result-more-unmet = { $count } more: see the report
window-result-report = report
window-result-not-available = not available
window-result-moment = Show in the report
window-result-moment-number = { $time } ({ $number } of { $count })
window-result-open-report = Open report
window-result-open-questionnaire = Open questionnaire
window-result-fly-yourself = Fly it yourself: { $job }
window-result-fly-next = Fly next: { $job }
window-result-watch-again = Watch again
window-result-fly-again = Fly again
window-result-choose = Choose another job
# Why the flight ended.
window-result-after = { $reason } after { $minutes } min { $seconds } s of flight
window-result-not-scored = The session was not scored. The recorded data is in { $folder }
window-result-not-scored-because = The session was not scored: { $error }

## Defect school

window-school-another = Another round
window-school-next = Next picture
window-school-start-page = Back to the start page
window-school-stop = Stop (Esc)
window-school-title = Defect school: picture { $number } of { $count }
window-school-again = You missed one of this kind. Once more:
window-school-question = What is in the middle?
window-school-complete = Defect school: round complete
window-school-right = { $right } of { $asked } right at the first attempt.
window-school-missed = Missed: { $kinds }. You will see them again soon.
window-school-no-more = There were no more pictures in this round.
window-school-mastered =
    { $count ->
        [one] You know { $count } kind of picture well: right at least four times in a row.
       *[other] You know { $count } kinds of pictures well: right at least four times in a row.
    }
window-school-failed = The defect school has failed. Please tell your instructor.
window-school-failed-because = The defect school has failed: { $error }

## Settings

window-settings-title = Settings
window-settings-language = Language
window-settings-language-about = Language of the window and of spoken warnings. Reports use it, too. Logs, data files and the vehicle's messages stay in English.
window-settings-keys = Keys
window-settings-keys-about = See which key does what, and choose other keys.
window-settings-units = Units
window-settings-units-about = Units on the screen. Reports and files always use metric units.
window-settings-metric = metric (m, m/s)
window-settings-us = U.S. (ft, mph)
window-settings-text-size = Text size
window-settings-text-size-about = Size of all words and numbers. At large sizes, the flight display leaves out the less important values, and long pages scroll with Page up, Page down or the mouse wheel.
window-settings-picture = Picture
window-settings-picture-about = Detail of the pictures. Auto is high with a graphics card and low without. A change takes effect in the next flight.
window-settings-auto = auto
window-settings-low = low
window-settings-medium = medium
window-settings-high = high
window-settings-ultra = ultra
window-settings-sound = Sound
window-settings-sound-about = All sound on or off.
window-settings-volume = Volume
window-settings-volume-about = Volume of the propellers and the warning tones.
window-settings-propellers = Propellers
window-settings-propellers-about = Propeller sound. It gets quieter as the drone flies away.
window-settings-warnings = Warnings
window-settings-warnings-about = A tone for each warning. A warning is always on the screen as well.
window-settings-speech = Speech
window-settings-speech-about = Warnings are spoken, if espeak-ng or spd-say is installed.
window-settings-restore = Restore all defaults
window-settings-restore-about = Resets all settings and keys.
window-settings-back-about = All changes are saved.
window-settings-key-unusable = This key cannot be used. Press another one, or Esc to cancel.
window-settings-nothing-changed = Nothing changed.
window-settings-keys-fixed = The keys come from { $file }. Change them there.
window-settings-press-key = press a key
window-settings-restore-keys = Restore default keys
window-settings-keys-awaiting = Press the new key. Esc cancels.
window-settings-keys-help = Enter or click a row, then press the new key. F11 always switches to full screen.
window-settings-key-set = { $key }: { $function }.
window-settings-key-exchanged = { $key }: { $function }. The key was taken: { $other } now has { $other_key }.
window-settings-key-refused = '{ $key }' cannot be used (allowed: { $allowed }).
window-settings-keys-restored = All keys have their defaults.
window-settings-all-restored = All settings have their defaults.
window-settings-file-invalid = The default settings are used, because the settings file is invalid: { $error }
window-settings-not-saved-invalid = Not saved, because the settings file is invalid: { $error }. Correct it, or restore all defaults.
window-settings-not-saved = Not saved: { $error }.

## Messages over the flight

window-flight-ghost-assessment = No ghost in an assessment.
window-flight-map-assessment = No map in an assessment.
window-flight-map-off = No map: this window was started with --no-map.
window-flight-ghost-expert = No ghost while you watch the expert.
window-flight-ghost-not-ready = The ghost is not ready yet: an expert flies this job in the background. Try again in a minute.
window-flight-ghost-changed = No ghost of your own flights: this job has changed since. An expert flies it in the background. Try again in a minute.
window-flight-ghost-no-session = No ghost without a session: choose a flight on the start page of the simulator.
window-flight-ghost = Ghost: { $words }.
window-flight-ghost-hidden = Ghost hidden.
window-flight-ghost-best = your best flight, { $overall } of { $most }
window-flight-ghost-of-expert = the expert's flight
window-flight-ghost-of-expert-changed = the expert's flight, because this job has changed since your own
window-flight-sound-on = Sound on.
window-flight-sound-off = Sound off.
window-flight-no-browser = Cannot open a browser ({ $error }). Enter the address above in a browser.
window-flight-frozen = Frozen.
window-flight-frozen-keys = Frozen. { $freeze }: continue    { $rewind }: rewind 10 s
window-flight-walk = Inspector: walking to place { $place }, { $seconds } s
window-flight-no-places = In this job, the inspector has only one place.
window-flight-walk-not-here = Only a window that flies the drone can send the inspector.
window-flight-loading = Loading { $what } ... { $pct }%
window-flight-loading-site = site and defects
window-flight-loading-bridges = bridges
window-flight-loading-ground = ground
window-flight-loading-plants = plants
window-flight-loading-water = water
window-flight-loading-graphics = graphics
window-loading-job = Loading job ... { $pct }%
window-loading-monitor = Loading site and monitor ... { $pct }%
window-loading-simulator = Starting simulator ... { $pct }%
window-loading-scores = Scoring telemetry ... { $pct }%
window-loading-record = Saving session data ... { $pct }%
window-loading-next-flights = Choosing next flights ... { $pct }%
window-flight-waiting-seed = Connected to the vehicle. Waiting for the session's seed ...
window-flight-waiting-vehicle = Waiting for the vehicle at { $address } ...
# Keys, at the beginning of a flight.
window-flight-keys-view = { $swap } views    { $map } map    { $large_map } large map    { $path } path    drag or { $look_left } { $look_right } look around    wheel zoom    { $follow } follow the drone
window-flight-keys-flight =
    { $arm } arm    { $take_off } take off    { $up } { $down } up and down    { $turn_left } { $turn_right } turn    { $forward } { $back } { $left } { $right } fly    { $lamp } lamp    { $snapshot } picture    { $land } land
    { $freeze } freeze    { $rewind } rewind 10 s    { $walk } walk
# Where larger text leaves no room for all keys.
window-flight-keys-short = { $arm } arm    { $take_off } take off    { $pause } pause; see the keys there
window-flight-keys-short-view = { $swap } views    { $map } map    { $follow } follow the drone

## Texts from `spandrel train`

window-train-form = { $title } (form { $form })
window-train-level = { $title } (level { $level } of { $levels })
window-train-tasks =
    { $count ->
        [one] { $count } task
       *[other] { $count } tasks
    }
window-train-bridges =
    { $count ->
        [one] { $count } bridge
       *[other] { $count } bridges
    }
window-train-defects =
    { $count ->
        [one] { $count } defect
       *[other] { $count } defects
    }
window-train-lesson-progress =
    { $done } of { $steps ->
        [one] { $steps } step
       *[other] { $steps } steps
    } of the lesson.
window-train-not-in-assessment = Not available in an assessment.
window-train-in-flight = A flight is in progress: end it first.
window-train-no-window = this program was built without the window
window-train-refused = The flight cannot start: { $error }
window-train-no-briefing = The briefing cannot be printed: { $error }
# A flight that an instructor has ordered at this station.
window-ordered = Your instructor has chosen a flight for { $trainee }: { $job } ({ $purpose }).
window-ordered-declined = You have declined the flight that your instructor chose.
