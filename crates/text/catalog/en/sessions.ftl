### Web pages: session list and a session's page.

## List

sessions-title = Sessions
sessions-trainee = Trainee
sessions-show = Show
sessions-show-all = Show all
sessions-import = Import flight
sessions-my-progress = My progress and plan
sessions-none = No sessions yet. Flights appear here after they end.
sessions-count =
    { $count ->
        [one] { $count } session, newest first
       *[other] { $count } sessions, newest first
    }
sessions-started = Started
sessions-overall = Overall
sessions-overall-of = { $score } of { $most }
sessions-certified = Certified
sessions-scenario = Scenario
sessions-purpose = Purpose
sessions-end = End

## A session's page

sessions-page = Session: { $scenario }
sessions-flight-time = flight time { $time }, { $end }
sessions-better = Do better
sessions-marks = Marks
sessions-video = Video
sessions-pictures = Photographs
sessions-scores = Scores
sessions-certification = Certification
sessions-tasks = Tasks
sessions-defects = Defects
sessions-compare-with = Compare with
sessions-show-moment = Show { $time }
sessions-next-flight = Next flight, based on this session alone: { $job }.
sessions-plan = Training plan, based on all sessions
sessions-no-marks = No marks yet. Marks appear on the timeline of the report; they do not change scores.
sessions-remove-mark = Remove
sessions-remove-mark-at = Remove the mark at { $time }
sessions-mark-time = Time on the report's slider (minutes:seconds)
sessions-mark-text = Text
sessions-your-name = Your name
sessions-add-mark = Add mark
sessions-mark-time-invalid = time = { $value }: invalid time (allowed: 0:00 to { $end }, minutes and seconds)
sessions-too-many-marks = there are already { $most } marks: remove one first
sessions-picture = Picture { $number }
sessions-standing-best = This is the personal best on this job.
sessions-standing-other = Personal best on this job: { $best } of { $most }.
sessions-standing-same = Change since last time: none.
sessions-standing-up =
    Change since last time: { $points ->
        [one] { $points } point
       *[other] { $points } points
    } up.
sessions-standing-down =
    Change since last time: { $points ->
        [one] { $points } point
       *[other] { $points } points
    } down.
sessions-standing-forms = Compared are the sessions on the equally difficult forms { $forms }.
sessions-report = Open the report
sessions-questions-answer = Answer the questionnaire
sessions-questions-continue = Continue the questionnaire ({ $answered } of { $all })
sessions-questions-view = View the questionnaire (all { $all } answered)
sessions-frames = Frames (CSV)
sessions-telemetry = Telemetry (tlog)
sessions-no-folder = The session folder is not on this machine, so the report, questionnaire and downloads are unavailable.
sessions-partial = The scores below cover only the part that was flown.
sessions-radar-caption = The four scores, 0 at the center, 100 at the edge
sessions-radar = Radar chart of the four scores
sessions-of-most = of { $most }
sessions-not-available = n/a
sessions-requirements = Requirements
sessions-requirement = Requirement
sessions-reached = Reached
sessions-needed = Needed
sessions-met = Met
sessions-yes = yes
sessions-no = no
sessions-not-attempted = not attempted
sessions-on-path-by-task = On-path share by task
sessions-task-results = Task results
sessions-task = Task
sessions-path-flown = Path flown
sessions-on-path = On-path share (%)
sessions-speeding = Speeding time (s)
sessions-crashes = Crashes
sessions-defects-found = Defects found
sessions-found-of = { $found } of { $placed }
sessions-crashes-outside =
    { $count ->
        [one] { $count } crash outside the tasks.
       *[other] { $count } crashes outside the tasks.
    }
sessions-unknown = unknown
sessions-defects-caption =
    { $found } of { $placed } found; { $hits } of { $pictures ->
        [one] { $pictures } picture
       *[other] { $pictures } pictures
    } showed a new defect
sessions-defect = Defect
sessions-found = Found
sessions-why-not = Why the best picture did not count
sessions-no-picture = no picture taken nearby
sessions-no-others = This trainee has no other sessions yet.
sessions-other = Other session
sessions-incomplete = incomplete
sessions-compare = Compare
sessions-compare-missing = { $field }: missing (required: a session ID)
