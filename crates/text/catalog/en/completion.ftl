# Completion of tasks and jobs, and the certification verdict.
completion-task-done = done ({ $share }% of path)
completion-task-part = partly flown ({ $share }% of path)
completion-task-not-attempted = not attempted
completion-complete = Complete: { $done } of { $tasks ->
        [one] { $tasks } task
       *[other] { $tasks } tasks
    }, { $share }% of the path
completion-incomplete = Incomplete: { $done } of { $tasks ->
        [one] { $tasks } task
       *[other] { $tasks } tasks
    }, { $share }% of the path
completion-not-landed = Incomplete: { $done } of { $tasks ->
        [one] { $tasks } task
       *[other] { $tasks } tasks
    }, { $share }% of the path, not landed at home
completion-unknown = Completion unknown: re-import this session
completion-excluded-sessions = { $count ->
        [one] { $count } incomplete session excluded
       *[other] { $count } incomplete sessions excluded
    }
completion-included-sessions = { $count ->
        [one] { $count } incomplete session included
       *[other] { $count } incomplete sessions included
    }
completion-certified = Certified
completion-not-certified = Not certified
completion-not-certified-why = Not certified: { $unmet }
completion-not-certified-more = Not certified: { $unmet } (and { $more } more)

# Aids of practice. The phrases stand after "This session was".
completion-rewound = { $rewinds ->
        [1] rewound once
        [2] rewound twice
       *[other] rewound { $rewinds } times
    }
completion-frozen = { $freezes ->
        [1] frozen once
        [2] frozen twice
       *[other] frozen { $freezes } times
    }
completion-rewound-and-frozen = { $rewound } and { $frozen }
