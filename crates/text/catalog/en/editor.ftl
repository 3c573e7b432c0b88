### Web pages: scenarios, scenario editor, training plan rules and uploads.

## Scenarios

editor-scenarios = Scenarios
editor-uploaded = uploaded
editor-shipped = shipped
editor-new-scenario = New scenario
editor-scenario-count =
    { $count ->
        [one] { $count } scenario
       *[other] { $count } scenarios
    }
editor-name = Name
editor-title = Title
editor-source = Source
editor-upload-scenario = Upload a scenario
editor-upload-scenario-note = One self-contained TOML file. It is validated before it is saved, and all errors are listed.
editor-file = File
editor-levels = { $levels } levels. Level 1: { $first }. Level { $standard }, the standard level: { $middle }. Level { $levels }: { $last }.
editor-edit = Edit
editor-copy = Make a copy to edit
editor-bridges = Bridges
editor-tasks = Tasks
editor-defects-to-find = Defects to find
editor-traffic = Traffic
editor-traffic-text = { $cars } cars, { $trucks } trucks, { $pedestrians } pedestrians
editor-wind = Wind
editor-wind-text = { $speed } m/s from { $from }°
editor-speed-limit = Speed limit
editor-time = Time
editor-time-text = full score up to { $best }, at most { $most }
editor-difficulty = Difficulty
editor-briefing = Briefing
editor-briefing-link = { $briefing }: tasks in order, hazards, what counts, and the site check, to read before the flight or to print.
editor-summary = Summary
editor-tolerances = Tasks and path tolerances
editor-task = Task
editor-tolerance = Path tolerance (m)
editor-site-plan = Site plan
editor-drawing = Drawing
editor-show = Show
editor-file-contents = File contents
editor-delete-scenario = Delete this scenario
editor-scenario-title = Scenario { $name }
editor-briefing-title = Briefing { $name }

## Imports

editor-imported = This recording was already imported as { $session }. No changes were made.
editor-imported-session = a session by { $name }
editor-import-note = Choose a .tlog file recorded by a ground station or the monitor. It must include the simulator's truth messages. The flight is scored before it is saved.
editor-import-trainee = Trainee
editor-import-scenario = Scenario
editor-import-aircraft = Aircraft
editor-import-recording = Recording
editor-import-button = Import
editor-import-title = Import flight
editor-import-unfit = cannot import this recording: { $reason }
editor-import-erased = trainee = { $name }: this trainee was erased after the flight, so the flight cannot be imported

## Training plan rules

editor-rules-title = Training plan rules
editor-rules-no-staircase = Difficulty does not adapt.
editor-rules-staircase = Difficulty adapts: { $up } harder after a session that met the criterion, { $down } easier after any other.
editor-rules-own = The rules determine which scenarios the training plans on this server recommend. This server uses its own rules.
editor-rules-shipped = The rules determine which scenarios the training plans on this server recommend. This server uses the shipped rules.
editor-rules-summary = { $rules } rules, criteria for { $drills } drills. A drill is done after { $needed } of { $of } sessions at its criterion.
editor-rules-toml = Rules (TOML)
editor-rules-upload = Upload
editor-rules-reset = Shipped rules
editor-rules-delete = Delete own rules
editor-rules-upload-button = Validate and save file
editor-rules-saved = The rules were saved and apply from now on.
editor-rules-invalid = This server's own rules are invalid, so the shipped rules apply. Instructors can correct them.

## Scenario editor

editor-edit-title = Edit { $name }
editor-not-checked = Not checked yet.
editor-form = Form
editor-overwrite = Overwrite the other version
editor-save = Save
editor-check = Check
editor-download = Download
editor-discard = Discard changes
editor-back = Back
editor-new-name = New name
editor-save-as = Save as
editor-file-note = The form changes this text and keeps its comments. Lessons, forms, difficulty levels and placed defects have no form: edit them here.
editor-scenario-toml = Scenario (TOML)
editor-preview = Preview
editor-stale = The drawings show the last valid version.
editor-no-preview = The drawings appear when the scenario is valid.
editor-new-lead = A new scenario starts as a copy of another one. Nothing is saved until you choose Save.
editor-start-from = Start from
editor-new-name-note = 1 to 40 characters: a-z, 0-9 and -
editor-edit-copy = Edit the copy
editor-saved = The scenario was saved.
editor-not-saved-because = Not saved. { $reason }
editor-conflict-exists = There is already a scenario '{ $name }'. Choose another name.
editor-conflict-deleted = Somebody deleted '{ $name }' since you opened it.
editor-conflict-changed = Somebody changed '{ $name }' since you opened it. Save your version under a new name, or overwrite the other version.
editor-too-many = there are already { $most } uploaded scenarios: remove one first
editor-name-too-long = { $file }: the name is too long (allowed: 60 characters)
editor-name-shipped = { $file }: '{ $name }' is the name of a shipped scenario; choose another
editor-name-reserved = { $file }: '{ $name }' is the name of a page of this server; choose another
editor-too-large = The file would become too large
editor-not-changed = Not changed: { $reason }
editor-upload-saved = { $name } was saved.

## Check of the editor

editor-check-too-long = { $file }: The check took too long and was stopped. Check the file with spandrel check.
editor-picture-caption = The site with the tasks' paths and the pad
editor-plan-caption = Site plan, north up
editor-south-caption = View from the south
editor-side-caption = Side view of { $bridge }
editor-problems-none = No problems.
editor-problems-none-warnings = No problems, { $warnings }.
editor-problems-only = { $problems }.
editor-problems-warnings = { $problems }, { $warnings }.
editor-problem-count =
    { $count ->
        [one] { $count } problem
       *[other] { $count } problems
    }
editor-warning-count =
    { $count ->
        [one] { $count } warning
       *[other] { $count } warnings
    }
editor-more-problems =
    { $count ->
        [one] and { $count } more problem
       *[other] and { $count } more problems
    }
editor-warning = Warning:
editor-notes = Notes ({ $count })
editor-line = Line { $line }

## Script of the editor

editor-script-not-checked-status = Not checked: HTTP status { $status }. Your changes are kept on this page.
editor-script-not-checked-login = Not checked: login required. Your changes are kept on this page.
editor-script-not-checked = Not checked: { $reason }. Your changes are kept on this page.
editor-script-no-plan = There is no plan yet: the scenario must be valid first.
editor-script-place = Click the site plan to set east and north, or press Escape.
editor-script-downloaded = { $status } Downloaded without the latest changes in the form.
editor-check-this = check this

## Form of the editor: sections and fields

editor-section-job = Job
editor-section-place = Place
editor-section-bridges = Bridges
editor-section-tasks = Tasks
editor-section-defects = Defects
editor-section-traffic = Traffic
editor-section-wind = Wind
editor-section-gusts = Gusts and changes of the wind
editor-section-light = Light
editor-section-rules = Rules and scoring
editor-section-count = { $section } ({ $count })
editor-add-task = Add a task
editor-add-bridge = Add a bridge
editor-add-gust = Add a gust
editor-more-keys = More keys ({ $count })
editor-move-up = Move up
editor-move-up-group = Move up: { $number } { $name }
editor-move-down = Move down
editor-move-down-group = Move down: { $number } { $name }
editor-remove = Remove
editor-remove-group = Remove: { $number } { $name }
editor-choose = Choose
editor-not-set = Not set
editor-default-choice = Default: { $value }
editor-east = East
editor-north = North
editor-up = Up
editor-place-on-plan = Place on the plan
editor-place-on-plan-field = Place on the plan: { $field }
editor-allowed = Allowed: { $allowed }.
editor-required = Required.
editor-default = Default: { $value }.
editor-with-unit = { $label } ({ $unit })

## Labels of keys; the units are added by the code

editor-key-format = Format
editor-key-name = Name
editor-key-title = Title
editor-key-briefing = Briefing
editor-key-seed = Seed
editor-key-form = Form
editor-key-level = Level
editor-key-latitude = Latitude
editor-key-longitude = Longitude
editor-key-altitude = Altitude
editor-key-size = Size
editor-key-spacing = Spacing
editor-key-water-level = Water level
editor-key-source = Source
editor-key-height = Height
editor-key-lake-width = Lake width
editor-key-axis = Axis
editor-key-relief = Relief
editor-key-lake-depth = Lake depth
editor-key-file = File
editor-key-pad = Pad
editor-key-pad-heading = Pad heading
editor-key-pad-half = Pad half
editor-key-inspector = Inspector
editor-key-truck = Truck
editor-key-truck-heading = Truck heading
editor-key-home-radius = Home radius
editor-key-centre = Center
editor-key-heading = Heading
editor-key-type = Type
editor-key-span = Span
editor-key-rise = Rise
editor-key-crown-depth = Crown depth
editor-key-springing-depth = Springing depth
editor-key-rib-width = Rib width
editor-key-rib-spacing = Rib spacing
editor-key-crown-gap = Crown gap
editor-key-panels = Panels
editor-key-column = Column
editor-key-deck-width = Deck width
editor-key-slab = Slab
editor-key-floorbeam-depth = Floorbeam depth
editor-key-floorbeam-width = Floorbeam width
editor-key-stringers = Stringers
editor-key-stringer-depth = Stringer depth
editor-key-stringer-width = Stringer width
editor-key-railing = Railing
editor-key-approach = Approach
editor-key-main-span = Main span
editor-key-side-span = Side span
editor-key-sag = Sag
editor-key-cable-clearance = Cable clearance
editor-key-cable-radius = Cable radius
editor-key-hanger-spacing = Hanger spacing
editor-key-hanger-radius = Hanger radius
editor-key-girder-depth = Girder depth
editor-key-leg-x = Leg x
editor-key-leg-y = Leg y
editor-key-pier-x = Pier x
editor-key-pier-y = Pier y
editor-key-pier-top = Pier top
editor-key-pier-height = Pier height
editor-key-anchorage = Anchorage
editor-key-kind = Kind
editor-key-bridge = Bridge
editor-key-stand-off = Stand off
editor-key-stand-off-tolerance = Stand off tolerance
editor-key-threshold = Threshold
editor-key-closed = Closed
editor-key-points = Points
editor-key-look-at = Look at
editor-key-too-close = Too close
editor-key-dark = Dark
editor-key-count = Count
editor-key-size-factor = Size factor
editor-key-elements = Elements
editor-key-kinds = Kinds
editor-key-detection = Detection
editor-key-lines = Lines
editor-key-none-placed = None placed
editor-key-cars = Cars
editor-key-trucks = Trucks
editor-key-pedestrians = Pedestrians
editor-key-car-speed = Car speed
editor-key-model = Model
editor-key-speed = Speed
editor-key-paper-force = Paper force
editor-key-from = From
editor-key-up = Up
editor-key-turbulence = Turbulence
editor-key-at = At
editor-key-duration = Duration
editor-key-peak = Peak
editor-key-over = Over
editor-key-start = Start
editor-key-cloud-cover = Cloud cover
editor-key-water-albedo = Water albedo
editor-key-ground-albedo = Ground albedo
editor-key-after-crash = After crash
editor-key-battery = Battery
editor-key-low-battery-return = Low battery return
editor-key-low-battery = Low battery
editor-key-critical-battery = Critical battery
editor-key-gnss-shadow = GNSS shadow
editor-key-respawn-after = Respawn after
editor-key-too-close-clear = Too close clear
editor-key-off-path-max = Off path max
editor-key-off-path-after = Off path after
editor-key-off-path-hold = Off path hold
editor-key-leave-after = Leave after
editor-key-visit-after = Visit after
editor-key-speeding-margin = Speeding margin
editor-key-speeding-hold = Speeding hold
editor-key-battery-green = Battery green
editor-key-battery-yellow = Battery yellow
editor-key-text-interval = Text interval
editor-key-guidance = Guidance
editor-key-frame-rate = Frame rate
editor-key-speed-limit = Speed limit
editor-key-max-speed = Max speed
editor-key-time-best = Time best
editor-key-time-max = Time max
editor-key-beta = Beta
editor-key-clearance = Clearance
editor-key-task-done = Task done
editor-key-exact-path = Exact path
editor-key-max-contacts = Max contacts
editor-key-max-contact-speed = Max contact speed
editor-key-min-battery = Min battery
editor-key-min-conformity = Min conformity
editor-key-min-precision = Min precision
editor-key-min-safety = Min safety
editor-key-min-accuracy = Min accuracy
editor-key-min-inspected = Min inspected
editor-key-inspection-speed = Inspection speed
editor-key-time-per-defect = Time per defect
editor-key-transit-time = Transit time
editor-key-max-time-ratio = Max time ratio
editor-key-max-gsd = Max gsd
editor-key-gsd-per-line-width = Gsd per line width
editor-key-max-smear = Max smear
editor-key-max-incidence = Max incidence
