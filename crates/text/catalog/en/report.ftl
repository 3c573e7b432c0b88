## Page

report-title = Session report: { $trainee }, { $started }
report-kicker = Session report
report-sections = Sections
report-print = Print
report-section-better = Do better
report-section-scores = Scores
report-section-tasks = Tasks
report-section-next = Next
report-section-flight = Flight
report-section-pictures = Pictures
report-section-defects = Defects
report-section-feedback = Feedback
report-section-coverage = Coverage
report-section-certification = Certification
report-section-record = Record

## Tables

report-table = Table: { $caption }
report-table-download = Download as CSV

## Words

report-contact-grave = person or vehicle
report-control-pilot = pilot
report-control-mission = mission
report-control-script = script
report-control-autopilot = autopilot
report-control-unknown = unknown
report-between-tasks = between tasks
report-on-path = on path
report-off-path = off path
report-task = task { $task }
report-not-attempted = not attempted
report-within-error = within error
report-beyond-error = beyond error
report-error-unknown = error unknown
report-measure-certification-sum = certification sum
report-measure-flight-time = flight time
report-measure-crashes = crashes
report-unit-points = points
report-measure-with-unit = { $measure } ({ $unit })
report-percent = { $value }%

## Column headings of several tables

report-column-task = task
report-column-name = name
report-column-state = state
report-column-time = time
report-column-time-s = time (s)
report-column-with = with
report-column-path = path
report-column-path-flown = path flown (%)
report-column-on-path-share = on-path share (%)
report-column-speeding-loss = speeding loss
report-column-speed = speed (m/s)
report-column-distance = distance (m)
report-column-clearance = clearance (m)
report-column-battery = battery (%)
report-column-wind = wind (m/s)
report-column-wind-from = wind from (deg)
report-column-number = number
report-column-place = place
report-column-added-air = difference from the undisturbed wind (m/s)
report-column-added-updraft = upward part (m/s)
report-column-east = east (m)
report-column-north = north (m)
report-column-height = height (m)
report-column-score = score
report-column-points = points
report-column-frame = frame
report-column-element = element
report-column-condition-state = condition state
report-column-cause = cause
report-column-kind = kind
report-column-found = found
report-column-reason = reason
report-column-scenario = scenario
report-column-flight-time = flight time
report-column-repetition = repetition
report-column-change = change
report-column-measurement-error = measurement error
report-column-minimal-change = minimal detectable change
report-column-pixel-size = pixel size (mm)
report-column-angle = angle from normal (deg)
report-column-illuminance = illuminance (lx)
report-column-blur = motion blur (px)

## Header

report-skip = Skip to what to do better
report-level = level { $level } of { $levels }
report-flight-time = Flight time { $duration }, { $end }.
report-telemetry-covers = The telemetry covers { $share }% of the session.
report-practice-aids = This session was { $aids }. It counts as practice: it is neither certified nor compared with others.
report-of-max = of { $max }
report-out-of-sight = Out of the inspector's sight for { $total }; longest for { $longest }, from { $from }.
report-gnss-lost = No GNSS position for { $total }; longest for { $longest }, from { $from }.
report-position-error = The drone's own position was wrong by up to { $position } m (at { $at }), its height by up to { $height } m (at { $height_at }).
report-heading-error = Its compass heading was wrong by up to { $degrees }° (at { $at }).
report-video-poor = Video link poor for { $total }; longest for { $longest }, from { $from }.
report-control-lost =
    { $count ->
        [one] Control link lost once.
       *[other] Control link lost { $count } times.
    }
report-air-disturbed = Air disturbed by a bridge (at least { $least } m/s different from the undisturbed wind) for { $total }; longest for { $longest }, from { $from }.
report-air-strongest = It was strongest at { $at }, { $place }: { $speed } m/s different from the undisturbed wind.
report-place-under = under the deck of bridge '{ $bridge }'
report-place-above = above the deck of bridge '{ $bridge }'
report-place-beside = beside bridge '{ $bridge }'
report-flow-lost = No optical flow over water for { $total }; longest for { $longest }, from { $from }.
report-ranges-lost =
    { $count ->
        [one] The downward range finder failed in its only reading over water.
       *[other] The downward range finder failed in { $lost } of { $count } readings over water.
    }
report-cold-battery = Cold battery ({ $temperature } °C): up to { $missing } V less than at 25 °C (at { $at }, leaving { $voltage } V), and { $share }% more charge used.
report-walks = Walks of the inspector: { $walks }.
report-walk = to place { $place } at { $moment }
report-walk-before = to place { $place } before lift-off

## Air around the bridges

report-air-title = Air around the bridges
report-air-about = The mean airflow in the simulator's wind model, without gusts. Vortices behind piers and decks are averaged and count as turbulence. Colors and arrows show the speed in the plane of the drawing.
report-air-wind = Around bridge '{ $bridge }', the undisturbed wind blew at { $speed } m/s from { $from }° at a height of 6 m.
report-air-level = Bridge '{ $bridge }' from above, { $height } m above the water: the median height of the flight there
report-air-across = Bridge '{ $bridge }' across the deck, { $station } m from its middle toward { $toward }°, looking toward { $heading }°
report-air-places = Where the bridges disturbed the air around the drone most (numbers in the drawings):
report-air-off = { $speed } m/s different from the undisturbed wind
report-air-caption = most disturbed air

## Scores

report-scores-part = The scores below cover only the part that was flown.
report-scores-figure = The four scores, 0 at the center, 100 at the edge
report-scores-radar = Radar chart of the four scores
report-scores-caption = scores
report-column-raw = raw
report-column-score-of-100 = score (of 100)
report-explain-battery-failed = did not land near the ground team before the battery or time ran out
report-explain-time = flight time { $time }; full score up to { $best }
report-explain-no-contacts = no contacts
report-explain-contacts =
    { $count ->
        [one] 1 contact, 3 points lost
       *[other] { $count } contacts, 3 points lost each
    }
report-explain-grave = a person or vehicle was hit: 0 points
report-explain-no-defects = no defects in this job
report-explain-defects =
    { $found } of { $placed ->
        [one] { $placed } defect
       *[other] { $placed } defects
    } found; { $hits } of { $taken ->
        [one] { $taken } picture
       *[other] { $taken } pictures
    } showed a new defect
report-explain-no-tasks = no tasks in this job
report-explain-none-attempted = no tasks attempted (the TASBID formula gives 50 points)
report-explain-skipped =
    { $skipped } of { $tasks ->
        [one] { $tasks } task
       *[other] { $tasks } tasks
    } not attempted
report-explain-lowest = lowest on-path share: { $share }% (task { $task }); speeding for { $speeding } s

## Do better

report-better-show = Show { $moment }
report-better-picture = picture { $picture }
report-better-practice = practice
report-better-next = Next flight:

## Next

report-next-note = Based on this session only. For a plan based on all of a trainee's sessions, see the trainee's page in the browser.
report-next-consequence = Consequence: { $reason }
report-next-caption = recommended scenarios
report-column-level = level
report-column-rule = rule
report-column-consequence-of = consequence of
report-column-measured = measured
report-column-limit = limit
report-column-urgency = urgency

## Certification

report-certification-intro = The certification profile adds pass/fail requirements that close loopholes in the four TASBID scores. Its own scores have other formulas than the TASBID scores, and other names.
report-certification-passed = All requirements met.
report-certification-met = met
report-certification-not-met = not met
report-certification-unmet = Not met: { $requirements }.
report-certification-exposure =
    Closer than { $limit } m to a surface for { $exposure } s; { $contacts ->
        [one] { $contacts } contact
       *[other] { $contacts } contacts
    } ({ $merged } after merging those less than a second apart); { $battery }% battery remaining at the end; flight time { $time } (this job needs { $needed } with the defects found).
report-certification-too-fine =
    { $count ->
        [one] 1 defect is too fine for this camera and does not count toward the detection accuracy.
       *[other] { $count } defects are too fine for this camera and do not count toward the detection accuracy.
    }
report-certification-scores-caption = certification scores
report-certification-contacts-caption = merged contacts
report-certification-pictures-caption = pictures by image quality
report-certification-visits-caption = task visits
report-certification-detection-caption = defects found by element, kind and condition state
report-certification-hit = hit
report-certification-no-hit = no hit
report-certification-not-counted = not counted
report-column-points-lost = points lost
report-column-result = result
report-column-new-defects = new defects
report-column-fails = why defects in the picture did not count
report-column-visits = visits
report-column-rms-distance = RMS distance / threshold
report-column-rms-speed = RMS speed above limit / limit
report-column-rms-framing = RMS framing error (deg)
report-column-too-close-share = too close (% of time)
report-column-grouped-by = grouped by
report-column-value = value
report-column-placed = placed

## Tasks

report-tasks-shares = Share of each task's time spent on the path and over the speed limit
report-tasks-on-path = on the path
report-tasks-speeding = over the speed limit
report-tasks-shares-title = On-path share and speeding by task
report-tasks-contacts = Contacts by task and object
report-tasks-no-contacts = No contacts.
report-tasks-contacts-title = Contacts by task and kind
report-tasks-done = done
report-tasks-part = partly flown
report-tasks-caption = tasks
report-tasks-contacts-caption = contacts
report-column-off-path-time = time off path (s)
report-column-speeding-time = speeding time (s)
report-column-mean-distance = mean distance (m)
report-column-max-distance = maximum distance (m)
report-column-max-speed = maximum speed (m/s)
report-column-min-clearance = minimum clearance (m)

## Defects

report-defects-none = This job has no defects.
report-defects-count =
    { $found } of { $placed ->
        [one] { $placed } defect
       *[other] { $placed } defects
    } { $found ->
        [one] was
       *[other] were
    } found.
report-defects-found = found
report-defects-missed = missed
report-defects-missed-head = Missed defects
report-defects-drawn = Each drawing shows the defect from 4 m away, viewed head-on with the lamp on.
report-defects-drawing = Defects: { $title }
report-defects-side = Side view of bridge '{ $bridge }'
report-defects-top = Top view of bridge '{ $bridge }'
report-defects-alt = Defect { $defect }, seen from 4 m away
report-defects-number = Defect { $defect }
report-defects-kind = { $kind }, condition state { $state }
report-defects-place = On { $member } ({ $element }), { $size }.
report-defects-cause = Cause: { $cause }.
report-defects-size-line = { $length } cm long, { $width } mm wide
report-defects-size-area = { $length } by { $width } cm
report-defects-outcome = It was { $outcome }.
report-defects-picture = picture { $picture }
report-defects-found-plain = found
report-defects-found-by = found by picture { $picture }
report-defects-in-view = clearly visible for { $seconds } s, first at { $moment }, but not photographed
report-defects-best-seen = best seen at { $moment }, but { $reasons }
report-defects-never = never in the camera's view; the drone came within { $distance } m at { $moment }
report-defects-caption = defects
report-column-defect = defect
report-column-element-name = element name
report-column-member = member
report-column-length-mm = length (mm)
report-column-width-mm = width (mm)
report-column-visible-time = time clearly visible (s)
report-column-closest = closest approach (m)
report-column-outcome = outcome

## Pictures

report-pictures-none = No pictures were taken.
report-pictures-drawn = The session contains no photographs, so each view is drawn from the bridge geometry. Only defects inside the dashed frame count.
report-pictures-count =
    { $count ->
        [one] { $count } picture
       *[other] { $count } pictures
    }: { $verdicts }.
report-pictures-count-hit = { $count } hit
report-pictures-count-repeat = { $count } repeat
report-pictures-count-too-dark = { $count } too dark
report-pictures-count-too-far = { $count } too far
report-pictures-count-too-oblique = { $count } too oblique
report-pictures-count-false = { $count } false
report-verdict-hit = hit
report-verdict-repeat = repeat
report-verdict-too-dark = too dark
report-verdict-too-far = too far
report-verdict-too-oblique = too oblique
report-verdict-false = false
report-verdict-near = near miss
report-reason-first = shows defect { $defects } for the first time
report-reason-again = defect { $defects } was already photographed
report-reason-none = no defect visible
report-reason-occluded = no defect visible (defect { $defect } is occluded)
report-picture-number = Picture { $picture }
report-picture-at = at { $moment }
report-picture-at-task = at { $moment }, task { $task }
report-picture-alt = Picture { $picture }: { $reason }
report-picture-lamp-on = lamp on
report-picture-lamp-off = lamp off
report-picture-sky = Center: sky, { $lamp }
report-picture-center = Center: { $name }, { $distance } m away, { $angle }° from the surface normal, { $pixel } mm per pixel, { $illuminance } lx ({ $lamp }), motion blur { $blur } px
report-pictures-sky = sky
report-pictures-on = on
report-pictures-off = off
report-pictures-caption = pictures
report-column-picture = picture
report-column-verdict = verdict
report-column-image-center = image center
report-column-required-illuminance = required illuminance (lx)
report-column-lamp = lamp

## Flight

report-chart-speed = Speed (m/s)
report-chart-distance = Distance to the current task's path (m)
report-chart-clearance = Clearance to the nearest surface (m)
report-chart-battery = Battery (%)
report-chart-wind = Horizontal wind at the drone (m/s)
report-chart-sticks = Stick positions (full travel = 1)
report-chart-label = { $title } over time; see the table below for the values
report-flight-timeline = Session timeline
report-flight-timeline-region = Timeline
report-flight-timeline-title = Control source, tasks, feedback, pictures and gaps over time
report-flight-zoom = Drag across a chart to zoom in. Double-click to reset the zoom. Click to move the slider.
report-flight-series = Download time series as CSV
report-flight-export = Every frame: { $link } on the session's page in the browser.
report-flight-marks = Instructor's marks
report-flight-play = Play
report-flight-pause = Pause
report-flight-time-label = Time
report-readout-task = Task
report-readout-path = Path
report-readout-distance = Distance
report-readout-speed = Speed
report-readout-clearance = Clearance
report-readout-battery = Battery
report-flight-color = Color flight path by
report-flight-video = Camera view
report-flight-video-missing = The video cannot be loaded from here. It is also on the session's page and in the session folder ({ $file }).
report-flight-reference = reference path
report-flight-contact = contact
report-flight-picture-hit = picture: hit
report-flight-plan = From above, north up
report-flight-plan-region = Plan
report-flight-south = View from the south
report-flight-elevation-region = Elevation
report-flight-side = Side view of bridge '{ $bridge }', with the nearby flight path
report-flight-3d = 3D view
report-flight-rotate = Rotate
report-flight-3d-region = 3D view of the flight
report-flight-3d-note = Drag or use the arrow keys to rotate. Use the + and − keys or the mouse wheel to zoom.
report-flight-3d-label = 3D model of the site and the flight path. Arrow keys rotate it; plus and minus zoom.
report-flight-slider = { $moment }, task { $task }, { $path }
report-timeline-pilot = flown by the pilot
report-timeline-other = flown by mission, script or autopilot
report-timeline-task = task
report-timeline-cue = cue
report-timeline-gap = no telemetry
report-timeline-flown-by = flown by
report-timeline-episode = { $cue } from { $from } to { $to }
report-timeline-picture = picture { $picture }: { $verdict }
report-timeline-pictures = pictures
report-timeline-note = note: { $note }
report-timeline-notes = notes
report-timeline-mark = mark: { $mark }
report-timeline-marks = marks
report-timeline-gaps = gaps
report-timeline-gap-for = no telemetry for { $seconds } s
report-timeline-gap-to-end = no telemetry until the end
report-stick-turn-clockwise = turn clockwise
report-stick-turn = turn
report-flight-caption = flight data, sampled every few seconds

## Feedback

report-cue-crash = crash
report-cue-too-close = too close
report-cue-speeding = speeding
report-cue-stand-off = stand-off
report-cue-off-path = off path
report-cue-battery-yellow = battery yellow
report-cue-battery-red = battery red
report-feedback-none = No feedback was given.
report-feedback-region = Feedback summary
report-feedback-figure = Time from the cue to the first stick movement; each dot is one cue; the bar marks the median
report-feedback-reactions-region = Reaction times
report-feedback-reactions = Reaction times by cue
report-feedback-note = A reaction is a stick movement of at least 10% of full travel within 5 s of the cue. If a stick was already moving, it may count as a reaction by coincidence.
report-feedback-answers = { $answers } of { $count }
report-feedback-caption = feedback shown
report-feedback-texts-caption = messages sent
report-feedback-notes-caption = instructor's notes
report-feedback-before = before lift-off
report-column-feedback = feedback
report-column-count = count
report-column-total-duration = total duration (s)
report-column-stick-reactions = stick reactions
report-column-median-reaction = median reaction time (s)
report-column-duration = duration (s)
report-column-reaction-time = reaction time (s)
report-column-text = text
report-column-note = note

## Coverage

report-coverage-shown = captured well
report-coverage-blurred = blurred
report-coverage-dark-on = too dark, lamp on
report-coverage-dark-off = too dark, lamp off
report-coverage-oblique = too oblique
report-coverage-far = too far
report-coverage-unpictured = in view, not photographed
report-coverage-unseen = never in view
report-coverage-none = No bridge surface can be inspected from the reference paths; all surfaces are beyond the camera's range.
report-coverage-summary = The pictures capture { $share } of the inspectable bridge surface well ({ $area } m² can be inspected from the reference paths).
report-coverage-rest = The rest: { $reasons }.
report-coverage-reason = { $share }% { $outcome }
report-coverage-note = A surface is inspectable if it is visible from at least one point of a reference path at { $pixel } mm per pixel or finer (at this resolution, a 1.27 mm crack, the limit between condition states 2 and 3, covers half a pixel; this camera achieves it from up to { $reach } m away) and at an angle of at most { $angle }° from the surface normal. It is captured well if a picture meets both limits, has enough light (including lamp light) for an exposure within the camera's limits, and has at most { $blur } px of motion blur. If several pictures show the same patch of surface, the best one counts.
report-coverage-figure = Coverage of each element's inspectable surface
report-coverage-bars = Surface coverage by element
report-coverage-bars-continued = Surface coverage by element, continued
report-coverage-all = all
report-coverage-caption = surface coverage; pixel size, angle, light and blur are averages over pictures that meet the required resolution and angle
report-column-inspectable = inspectable area (m²)
report-column-area = { $outcome } (m²)

## Record

report-record-frames-note = In gaps longer than 1 s, missing frames repeat the last known position and are scored at that position.
report-record-files-note = This report is computed from the telemetry, the scenario file and the aircraft file. The same three files always produce the same report.
report-record-no-gaps = The telemetry has no gaps longer than 0.2 s.
report-record-gaps = Telemetry gaps longer than 0.2 s: { $gaps }. Interpolated frames: { $interpolated }. Missing frames: { $missing }. Telemetry covers { $share }% of the session.
report-record-control-caption = control source over time
report-record-caption = session data
report-column-from = from
report-column-to = to
report-column-flown-by = flown by
report-column-item = item
report-record-session = session
report-record-trainee = trainee
report-record-purpose = purpose
report-record-no-purpose = not specified
report-record-started = started
report-record-scenario = scenario
report-record-scenario-hash = scenario SHA-256
report-record-aircraft = aircraft
report-record-aircraft-hash = aircraft SHA-256
report-record-telemetry-hash = telemetry SHA-256
report-record-seed = seed
report-record-scorer = scorer
report-record-frames = frames scored
report-record-received = MAVLink frames received
report-record-lost = frames lost
report-record-duplicate = duplicate frames
report-record-reordered = frames out of order

## Briefing

report-briefing-title = Briefing: { $title }
report-briefing-lead = Briefing for the job { $job }
report-briefing-notes = From your instructor
report-briefing-pictures = Pictures from your instructor
report-briefing-picture-missing = The picture { $file } is missing.
report-briefing-site = Site
report-briefing-tasks = Tasks, in this order
report-briefing-conditions = Conditions
report-briefing-hazards = Hazards
report-briefing-counts = What counts
report-briefing-check = Site check before takeoff
report-briefing-above = From above, north up
report-briefing-side = Bridge '{ $bridge }' from the side
report-briefing-south = From the south
report-briefing-task-region = Tasks
report-briefing-task = Task
report-briefing-where = Where
report-briefing-length = Length (m)
report-briefing-height = Height above the pad (m)
report-briefing-stand-off = Stand-off (m)
report-briefing-lamp = Lamp
report-briefing-lamp-needed = needed
report-briefing-heights = { $low } to { $high }

## Progress

report-progress-repetition = repetition { $repetition }
report-progress-scores = The four scores by repetition
report-progress-scores-title = Scores by repetition
report-progress-shares = On-path share by task (%)
report-progress-shares-title = On-path share by task and repetition
report-progress-crashes = Crashes by object
report-progress-crashes-none = None.
report-progress-crashes-title = Crashes by kind and repetition
report-progress-curves = Learning curves
report-progress-curve = Learning curve of { $score }
report-progress-curves-note = Each curve is a fit of the power law of practice to the repetitions. The ring marks the prediction for the next repetition, which may exceed the maximum score.
report-progress-curves-caption = learning curves (score = first score × repetition ^ exponent)
report-progress-changes-caption = changes since the preceding repetition
report-progress-caption = scores, time and crashes by repetition
report-progress-on-path-caption = on-path share by task
report-progress-too-few = A learning curve requires { $count } repetitions of the same job.
report-column-repetitions = repetitions
report-column-first = first
report-column-exponent = exponent
report-column-next = next
report-column-bridge-crashes = bridge crashes
report-column-ground-crashes = ground crashes
report-column-water-crashes = water crashes
report-column-other-crashes = other crashes
report-column-grave-crashes = person or vehicle crashes

## Learning management system

report-scorm-result = { $points } of 100. { $verdict }
report-scorm-missing = No learning management system found.
report-scorm-sent = Result sent to the learning management system.
report-scorm-refused = The learning management system did not accept the result.
