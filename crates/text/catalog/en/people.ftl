### Web pages: trainees, classes, assignments, rubric, cohort.

## Trainees

people-trainees = Trainees
people-pseudonym = Pseudonym
people-role = Role
people-age = Age
people-drones = Drones
people-games = Games
people-no-trainees = No trainees yet. Trainees appear here after their first flight.
people-users =
    { $count ->
        [one] { $count } user
       *[other] { $count } users
    }
people-plan-rules = Training plan rules
people-rubric = Rubric
people-experience-none = none
people-experience-some = some
people-experience-regular = regular

## A trainee's page

people-trainee = Trainee { $name }
people-assignments = Assignments
people-next-flights = Next flights
people-progress = Progress
people-sessions = Sessions
people-no-sessions = No sessions yet.
people-details = Details
people-data = Data
people-download = Download all data for { $name }
people-of-classes =
    { $count ->
        [one] Class:
       *[other] Classes:
    }
people-plan-between = Fly between { $from } and { $until }.
people-plan-overdue = It has been a long time since the last flight, and skills fade without practice.
people-plan-consequence = Consequence: { $reason }
people-plan-drills = Drills
people-plan-drill = { $drill }: { $progress }.
people-plan-drill-next = { $drill }: { $progress }; next level: { $level }.
people-changes = Changes
people-changes-compared = Compared with { $session }.
people-changes-session = the previous session on the same job
people-changes-forms = That session flew form { $before }, this one form { $now }, which is equally difficult.
people-change-better = { $what }: { $before } → { $now }, better
people-change-worse = { $what }: { $before } → { $now }, worse
people-include-incomplete = Include incomplete sessions
people-exclude-incomplete = Exclude incomplete sessions
people-job-sessions =
    { $count ->
        [one] { $count } session
       *[other] { $count } sessions
    }
people-details-note = Role: { $role }. The following information is optional and used only for the study.
people-not-specified = not specified
people-age-years = Age (years)
people-drone-experience = Experience with drones
people-gaming-experience = Experience with video games
people-save = Save
people-details-changed = these details have been changed elsewhere: reload the page and check the current details
people-erase = Erase
people-erase-note = This erases { $name } and all their sessions, answers and session folders. This cannot be undone.
people-erase-again = Enter the pseudonym to confirm
people-erase-button = Erase permanently
people-erase-wrong-name = the pseudonym you typed is not { $name }: nothing was erased
people-erase-self = you would lock yourself out: ask another administrator to erase you

## Classes

people-classes = Classes
people-no-classes = No classes yet.
people-class-count =
    { $count ->
        [one] { $count } class
       *[other] { $count } classes
    }
people-class = Class
people-members = Members
people-new-class = New class
people-name = Name
people-new-class-note = Letters, digits, - and _. A trainee may be in several classes.
people-create-class = Create class
people-class-title = Class { $name }
people-no-members = No trainees in this class yet.
people-no-class-jobs = No jobs assigned to this class.
people-assign-to-class = Assign a job to this class
people-add-trainees = Add trainees
people-add-pseudonyms = Pseudonyms, separated by spaces or commas
people-add-note = You can add trainees before their first flight.
people-add-button = Add to class
people-delete = Delete
people-delete-this-class = Delete this class
people-delete-note = This deletes the class and its assignments. The trainees and their sessions remain.
people-delete-class = Delete class
people-head-trainee = Trainee
people-head-last = Last session
people-head-certified = Certified
people-head-next = Recommended next
people-head-open = Open assignments
people-head-change = Change
people-not-flown = not flown yet
people-remove = Remove
people-remove-member = Remove { $name } from this class
people-trainee-count =
    { $count ->
        [one] { $count } trainee
       *[other] { $count } trainees
    }
people-job-level = { $job }, level { $level }
people-class-name = name = { $name }: invalid class name (allowed: 1 to 32 letters, digits, '-' or '_', starting with a letter or digit)
people-class-exists = name = { $name }: there is already a class with this name
people-too-many-members =
    { $count ->
        [one] trainees: { $count } pseudonym (allowed: 1 to { $most } at once)
       *[other] trainees: { $count } pseudonyms (allowed: 1 to { $most } at once)
    }
people-lookalike = trainees: there is no '{ $name }', but a trainee '{ $other }'; use that pseudonym

## Assignments

people-no-open = No open assignments.
people-open-count =
    { $count ->
        [one] { $count } open assignment
       *[other] { $count } open assignments
    }
people-done-count = Done ({ $count })
people-finished = Finished assignments
people-assign-to = Assign a job to { $name }
people-job = Job
people-due = Due
people-state = State
people-assigned-to = Assigned to
people-to-fly = To fly it
people-change = Change
people-assigned-by = { $target }, by { $instructor }
people-job-level-or-harder = { $job }, level { $level } or harder
people-job-form = { $job }, form { $form }
people-target-class = class { $name }
people-remove-assignment = Remove assignment { $job }
people-none = none
people-overdue-since = overdue since { $day }
people-due-on = due { $day }
people-done = Done
people-open = Open
people-overdue = Overdue
people-assignment-count =
    { $count ->
        [one] { $count } assignment
       *[other] { $count } assignments
    }
people-assign = Assign
people-assign-job-to = Assign { $job } to { $name }
people-choice-levels = { $job } (levels { $first } to { $last })
people-choice-forms = { $job } (forms { $forms })
people-assign-note = The assignment is done after the first complete flight of the job that starts after you assign it.
people-assign-variant = Level or form (optional)
people-assign-variant-note = A harder level counts as well. Without a level or form, any counts.
people-assign-due = Due (end of the day, UTC)
people-assign-title-trainee = Assign a job to trainee { $name }
people-assign-title-class = Assign a job to class { $name }
people-assign-one-target = either trainee or class is required
people-assign-variant-unknown = variant = { $value }: unknown level or form of { $job } (allowed: { $allowed })
people-assign-no-variants = variant = { $value }: unknown level or form of { $job } (allowed: none: the job has no levels or forms)
people-assign-due-invalid = due = { $value }: invalid date (allowed: { $first } to { $last })

## Rubric

people-rubric-count = { $signed } of { $all } criteria signed off
people-rubric-of = Rubric of { $name }
people-criteria = Criteria
people-history = History
people-no-history = Nothing signed off yet.
people-edit-criteria = Edit the criteria
people-signed = Signed off
people-signed-by = { $signed } { $day } by { $instructor }
people-signed-by-with-note = { $signed } { $day } by { $instructor }: { $note }
people-not-signed = Not signed off
people-withdraw = Withdraw
people-note-optional = Note (optional)
people-sign = Sign off
people-reason = Reason
people-withdraw-sign-off = Withdraw sign-off
people-your-name = Your name
people-button-for = { $button }: { $criterion }
people-erased-user = an erased user
people-time = Time
people-criterion = Criterion
people-action = Action
people-by = By
people-note = Note
people-history-count =
    { $count ->
        [one] { $count } entry, newest first
       *[other] { $count } entries, newest first
    }
people-rubric-own = The criteria that instructors sign off for each trainee. This server uses its own rubric.
people-rubric-shipped = The criteria that instructors sign off for each trainee. This server uses the shipped rubric.
people-rubric-note = Sign-offs belong to a criterion's id. If you remove a criterion, its sign-offs stay in the history.
people-rubric-edit = Edit
people-rubric-toml = Rubric (TOML)
people-rubric-reset = Shipped rubric
people-rubric-delete = Delete own rubric
people-rubric-saved = The rubric was saved and applies from now on.
people-rubric-invalid = This server's own rubric is invalid, so the shipped one applies. Instructors can correct it.
people-already-signed = { $criterion }: already signed off; reload the page
people-already-withdrawn = { $criterion }: already withdrawn; reload the page

## Questionnaire

people-answer-invalid = { $field } = { $value }: invalid answer (allowed: { $least } to { $most })
people-answer-invalid-step = { $field } = { $value }: invalid answer (allowed: { $least } to { $most } in steps of { $step })

## Cohort

people-cohort = Cohort
people-cohort-scenarios = Scenarios to include
people-cohort-repetitions = Repetitions
people-cohort-show = Show
people-cohort-download = Download as offline page
people-cohort-nothing = these scenarios have no sessions to include
