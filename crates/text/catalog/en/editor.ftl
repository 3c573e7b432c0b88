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
editor-traffic-text =
    { $cars ->
        [one] { $cars } car
       *[other] { $cars } cars
    }, { $trucks ->
        [one] { $trucks } truck
       *[other] { $trucks } trucks
    }, { $pedestrians ->
        [one] { $pedestrians } pedestrian
       *[other] { $pedestrians } pedestrians
    }
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
editor-briefing-pictures = Pictures of the briefing
editor-briefing-pictures-note = PNG or JPEG, at most 4 MiB and 8192 px wide and high; at most { $most } pictures.
editor-briefing-picture-file = Picture
editor-briefing-picture-add = Add the picture
editor-briefing-picture-remove = Remove the picture: { $caption }
editor-briefing-picture-too-many = There are already { $most } pictures: remove one first.
editor-briefing-picture-unusable = { $file }: { $problem ->
    [type] neither a PNG nor a JPEG file
    [damaged] the file is damaged
   *[size] { $width } x { $height } px (allowed: at most 8192 px wide and high)
 }
editor-briefing-picture-conflict = Somebody changed '{ $name }' since you opened this page. Nothing was changed: check the page, and try again.
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
editor-rules-summary =
    { $rules ->
        [one] { $rules } rule
       *[other] { $rules } rules
    }, criteria for { $drills ->
        [one] { $drills } drill
       *[other] { $drills } drills
    }. A drill is done after { $needed } of { $of ->
        [one] { $of } session
       *[other] { $of } sessions
    } at its criterion.
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
editor-file-note = The form changes this text and keeps its comments. Lessons, forms and difficulty levels have no form: edit them here.
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
editor-section-pictures = Pictures of the briefing
editor-section-place = Place
editor-section-bridges = Bridges
editor-section-tasks = Tasks
editor-section-defects = Defects
editor-section-traffic = Traffic
editor-section-drones = Other drones
editor-section-ropes = Ropes and cables
editor-section-wind = Wind
editor-section-gusts = Gusts and changes of the wind
editor-section-light = Light
editor-section-rules = Rules and scoring
editor-section-count = { $section } ({ $count })
editor-pictures-note = Add and remove files on the scenario's page. A saved scenario keeps only the files that it lists.
editor-add-task = Add a task
editor-add-bridge = Add a bridge
editor-add-drone = Add a drone
editor-add-rope = Add a rope
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

# Allowed values and defaults of keys. The English ones are those in scenarios/README.md.
editor-allowed-range = { $low } to { $high }
editor-allowed-whole-number = whole number { $low } to { $high }
editor-allowed-numbers = { $count } numbers, each { $low } to { $high }
editor-allowed-positions = list of [east, north, up], each { $low } to { $high }
editor-allowed-whole-numbers = list of whole numbers, each { $low } to { $high }
editor-allowed-listed-numbers = list of whole numbers among { $numbers }
editor-allowed-true-or-false = true or false
editor-default-first-form = the first form
editor-default-standard-level = the standard level
editor-default-middle-span = the middle span
editor-default-first-pier = the first pier
editor-default-by-level = by level: { $values }
editor-default-by-kind = by kind: { $values }
editor-default-true-for = true for { $first } and { $second }

## Labels of keys; the units are added by the code

editor-key-format = Format
editor-key-name = Name
editor-key-title = Title
editor-key-briefing = Briefing
editor-key-caption = Caption
editor-key-seed = Seed
editor-key-form = Form
editor-key-level = Level
editor-key-latitude = Latitude
editor-key-longitude = Longitude
editor-key-altitude = Altitude
editor-key-size = Side length
editor-key-spacing = Grid spacing
editor-key-water-level = Water level
editor-key-source = Terrain source
editor-key-height = Height
editor-key-lake-width = Lake width
editor-key-axis = Valley direction
editor-key-relief = Mountain height
editor-key-lake-depth = Lake depth
editor-key-file = File
editor-key-offset = Height offset
editor-key-water-depth = Water depth
editor-key-photo = Aerial photograph
editor-key-pad = Pad
editor-key-pad-heading = Pad heading
editor-key-pad-half = Half width of the pad
editor-key-inspector = Inspector position
editor-key-places = Inspector's other places
editor-key-truck = Crew truck
editor-key-truck-heading = Crew truck heading
editor-key-home-radius = Landing radius around the pad
editor-key-centre = Center
editor-key-heading = Heading
editor-key-type = Type
editor-key-span = Span
editor-key-rise = Rise
editor-key-crown-depth = Rib depth at the crown
editor-key-springing-depth = Rib depth at the springing
editor-key-rib-width = Rib width
editor-key-rib-spacing = Rib spacing
editor-key-crown-gap = Interlayer height at the crown
editor-key-panels = Number of panels
editor-key-column = Column width
editor-key-deck-width = Deck width
editor-key-slab = Slab thickness
editor-key-floorbeam-depth = Floorbeam depth
editor-key-floorbeam-width = Floorbeam width
editor-key-stringers = Number of stringers
editor-key-stringer-depth = Stringer depth
editor-key-stringer-width = Stringer width
editor-key-railing = Railing height
editor-key-approach = Approach length
editor-key-main-span = Main span
editor-key-side-span = Side span
editor-key-sag = Cable sag
editor-key-cable-clearance = Cable height above the deck
editor-key-cable-radius = Cable radius
editor-key-hanger-spacing = Hanger spacing
editor-key-hanger-radius = Hanger radius
editor-key-girder-depth = Girder depth
editor-key-leg-x = Tower leg length
editor-key-leg-y = Tower leg width
editor-key-pier-x = Pier length
editor-key-pier-y = Pier width
editor-key-pier-top = Pier top depth below the deck
editor-key-pier-height = Pier height
editor-key-anchorage = Anchorage length
editor-key-spans = Number of spans
editor-key-end-span = End span
editor-key-simple-spans = Simple spans (0 or 1)
editor-key-joint-gap = Joint gap
editor-key-girders = Number of girders
editor-key-girder-spacing = Girder spacing
editor-key-overhang = Deck overhang
editor-key-haunch = Haunch height
editor-key-web-depth = Web depth
editor-key-web = Web thickness
editor-key-flange-width = Flange width
editor-key-flange = Flange thickness
editor-key-cross-frame-spacing = Cross-frame spacing
editor-key-section = Standard section
editor-key-diaphragm-spacing = Diaphragm spacing
editor-key-diaphragm = Diaphragm thickness
editor-key-depth = Truss depth at midspan
editor-key-hip-depth = Truss depth at the hips
editor-key-truss-spacing = Truss spacing
editor-key-chord = Chord size
editor-key-gusset = Gusset plate thickness
editor-key-bracing-depth = Bracing depth
editor-key-midspan-depth = Depth at midspan
editor-key-pier-depth = Depth at the piers
editor-key-haunch-length = Haunch length
editor-key-cells = Number of cells
editor-key-cell-width = Cell width
editor-key-web-slope = Inclination of the outer webs
editor-key-bottom-slab = Bottom slab thickness
editor-key-clear-span = Clear span
editor-key-ring = Barrel thickness
editor-key-cover = Road above the crown
editor-key-width = Width between outer faces
editor-key-wall = Spandrel wall thickness
editor-key-parapet = Parapet height
editor-key-pier = Pier thickness
editor-key-cutwater = Cutwater length
editor-key-tower-height = Tower height above the deck
editor-key-stays = Stays per side
editor-key-anchor-spacing = Anchorage spacing at the tower
editor-key-stay-radius = Stay radius
editor-key-barrier = Barrier height
editor-key-drain-spacing = Drain spacing
editor-key-bearing = Bearing height
editor-key-pedestal = Pedestal height
editor-key-cap-depth = Cap depth
editor-key-cap-width = Cap width
editor-key-columns = Columns per pier
editor-key-round-columns = Round columns (0 or 1)
editor-key-column-height = Column height
editor-key-abutment = Abutment height
editor-key-kind = Kind
editor-key-bridge = Bridge
editor-key-span-number = Span number
editor-key-support-number = Support number
editor-key-stand-off = Stand-off
editor-key-stand-off-tolerance = Stand-off tolerance
editor-key-threshold = Path tolerance
editor-key-closed = Closed path
editor-key-points-relative-to = Bridge of the path points
editor-key-points = Points
editor-key-look-at = Camera target
editor-key-too-close = Too-close warning distance
editor-key-dark = Lamp required
editor-key-count = Number of defects
editor-key-placement = Placement
editor-key-size-factor = Size factor
editor-key-elements = Elements
editor-key-kinds = Defect types
editor-key-detection = Predicted detection
editor-key-lines = Number of cracks and lines
editor-key-none-placed = No defects placed
editor-key-cars = Cars
editor-key-trucks = Trucks
editor-key-pedestrians = Pedestrians
editor-key-car-speed = Traffic speed
editor-key-vehicle = Aircraft
editor-key-spread = Random delay of the start
editor-key-wait = Time at each point
editor-key-repeat = Repeat the path
editor-key-diameter = Diameter
editor-key-length = Length
editor-key-mass = Mass
editor-key-model = Wind model
editor-key-speed = Speed
editor-key-paper-force = Force (paper model)
editor-key-from = Wind from
editor-key-up = Vertical wind speed
editor-key-turbulence = Turbulence
editor-key-at = Start time
editor-key-duration = Duration
editor-key-peak = Peak gust speed
editor-key-over = Transition time
editor-key-start = Start date and time
editor-key-cloud-cover = Cloud cover
editor-key-water-albedo = Water albedo
editor-key-ground-albedo = Ground albedo
editor-key-visibility = Visual range
editor-key-rain = Rain
editor-key-snow = Snowfall
editor-key-after-crash = After crash
editor-key-battery = Battery model
editor-key-low-battery-return = Return on low battery
editor-key-low-battery = Low battery level
editor-key-critical-battery = Critical battery level
editor-key-gnss-shadow = GNSS shadowing
editor-key-stick-response = Response to the sticks
editor-key-compass = Compass errors near steel
editor-key-wakes = Wind around piers and decks
editor-key-water = Optical flow fails over water
editor-key-battery-temperature = Battery temperature
editor-key-sky = Real GNSS sky
editor-key-almanac = Almanac file
editor-key-radio = Radio shadow of bridges
editor-key-severity = Severity
editor-key-hazard-severity = Severity of hazards
editor-key-respawn-after = Respawn delay
editor-key-too-close-clear = Too-close warning clears at
editor-key-off-path-max = Maximum off-path distance
editor-key-off-path-after = Off-path warning delay
editor-key-off-path-hold = Minimum off-path warning time
editor-key-leave-after = Time to leave a task
editor-key-visit-after = Time to revisit a task
editor-key-speeding-margin = Speeding margin
editor-key-speeding-hold = Minimum speeding warning time
editor-key-battery-green = Green battery from
editor-key-battery-yellow = Yellow battery from
editor-key-text-interval = Minimum text interval
editor-key-guidance = Guidance
editor-key-frame-rate = Scoring frame rate
editor-key-speed-limit = Speed limit
editor-key-max-speed = Maximum speed
editor-key-time-best = Time for full score
editor-key-time-max = Time limit
editor-key-beta = Recall weight (beta)
editor-key-clearance = Exposure clearance
editor-key-task-done = Task complete at
editor-key-exact-path = Exact path distance
editor-key-max-contacts = Maximum contacts
editor-key-max-contact-speed = Maximum contact speed
editor-key-min-battery = Minimum battery at landing
editor-key-min-conformity = Minimum conformity
editor-key-min-precision = Minimum precision
editor-key-min-safety = Minimum safety
editor-key-min-accuracy = Minimum accuracy
editor-key-min-inspected = Minimum path share inspected
editor-key-inspection-speed = Inspection speed
editor-key-time-per-defect = Time per defect
editor-key-transit-time = Transit time
editor-key-max-time-ratio = Maximum time ratio
editor-key-max-gsd = Maximum GSD
editor-key-gsd-per-line-width = GSD per line width
editor-key-max-smear = Maximum motion blur
editor-key-max-incidence = Maximum incidence angle
