## Cohort

cohort-title = Cohort report
cohort-sections = Sections
cohort-summary =
    { $trainees ->
        [one] { $trainees } trainee
       *[other] { $trainees } trainees
    }, { $sessions ->
        [one] { $sessions } session
       *[other] { $sessions } sessions
    } of { $scenarios }.
cohort-certified =
    Certified: { $certified } of { $sessions ->
        [one] { $sessions } session
       *[other] { $sessions } sessions
    }.
cohort-group =
    { $trainees ->
        [one] { $trainees } trainee
       *[other] { $trainees } trainees
    } flew { $repetitions } or more times.
cohort-section-limitations = Limitations
cohort-section-distributions = Scores of the first sessions
cohort-section-people = Scores by trainee and task
cohort-section-crashes = Crashes
cohort-section-reliability = Reliability of the measures
cohort-section-repetitions = Repetitions
cohort-section-learning = Learning curves
cohort-section-individual = Individual progress
cohort-section-answers = Answers
cohort-section-self-rating = Self-rating vs. measured score
cohort-section-causal = Demand, strain, performance
cohort-section-files = Table downloads
cohort-files-note = Tables with one row per trainee are not embedded because they would make this page too large. { $command } writes { $files }.

## Answers

cohort-answer-strongly-agree = strongly agree
cohort-answer-agree = agree
cohort-answer-neutral = neutral
cohort-answer-disagree = disagree
cohort-answer-strongly-disagree = strongly disagree
cohort-answers-first =
    All first sessions (up to { $count ->
        [one] { $count } answer
       *[other] { $count } answers
    })
cohort-answers-first-title = Answers from all first sessions
cohort-answers-later = Trainees with repeat sessions: repetition { $repetition }
cohort-answers-later-title = Answers for repetition { $repetition }
cohort-self-rating-correlation =
    Spearman correlation between self-rating and overall score: { $correlation }, { $trainees ->
        [one] { $trainees } trainee
       *[other] { $trainees } trainees
    }.
cohort-self-rating-caption = self-rating vs. measured score
cohort-column-self-rating-scale = self-rating (1 to 5)
cohort-column-measured = measured score (%)
cohort-column-trainee = trainee
cohort-column-trainees = trainees
cohort-column-completion = completion
cohort-column-certification = certification

## Causal model

cohort-causal-intro = Does demand increase strain, does strain reduce performance, and does in-flight feedback weaken the effect of demand on strain? Estimated from the first sessions of all trainees who answered the questionnaire.
cohort-causal-none = No estimate available: too few trainees answered the questionnaire, or their answers do not vary. At least { $count } trainees with complete answers are recommended.
cohort-causal-count =
    { $count ->
        [one] { $count } trainee with complete answers.
       *[other] { $count } trainees with complete answers.
    }
cohort-causal-caution = With fewer than { $recommended }, the model can miss medium effects. It describes these trainees only and does not generalize.
cohort-causal-diagram = Path diagram; dashed arrows mark effects whose 95% confidence interval includes zero
cohort-causal-diagram-region = Causal model
cohort-causal-diagram-title = Demand, strain, performance and feedback
cohort-causal-scales = Demand, strain and feedback are rated from 1 to 5; performance is the overall score as a percentage of the maximum.
cohort-causal-indirect = Indirect effect of one unit of demand on performance via strain, by feedback helpfulness, with 95% confidence intervals
cohort-causal-indirect-region = Indirect effects
cohort-causal-indirect-axis = % of overall score per unit of demand
cohort-causal-indirect-title = Indirect effect of demand by feedback helpfulness
cohort-causal-low = low feedback
cohort-causal-mean = mean feedback
cohort-causal-high = high feedback
cohort-causal-level = { $level } ({ $feedback })
cohort-causal-moderation = moderation: change in effect per unit of feedback
cohort-causal-effects-caption = indirect effect of demand on performance via strain, with bootstrap confidence intervals
cohort-causal-coefficients-caption = coefficients of the two regressions
cohort-column-feedback-level = feedback level
cohort-column-feedback = feedback
cohort-column-effect = effect (%)
cohort-column-ci-lower = 95% CI lower bound
cohort-column-ci-upper = 95% CI upper bound
cohort-column-outcome = outcome
cohort-column-term = term
cohort-column-estimate = estimate
cohort-column-standard-error = standard error
cohort-term-intercept = intercept
cohort-term-demand = demand
cohort-term-strain = strain
cohort-term-performance = performance
cohort-term-interaction = demand x feedback

## First sessions

cohort-histogram = Histogram of { $score }; the line marks the mean
cohort-first-caption = first sessions
cohort-no-tasks = no tasks
cohort-individuals-caption = first session of each trainee
cohort-shares = On-path share by trainee and task
cohort-shares-figure = Share of time on the path
cohort-crashes-count =
    { $count ->
        [one] { $count } crash
       *[other] { $count } crashes
    } in the first sessions.
cohort-crashes-by-object = By object
cohort-crashes-by-kind-title = Crashes by kind
cohort-crashes-by-task = By task
cohort-crashes-by-task-title = Crashes by task
cohort-crashes-by-trainee = By trainee
cohort-crashes-by-trainee-title = Crashes by trainee
cohort-crashes-outside = outside
cohort-crashes-all = all
cohort-column-mean = mean
cohort-column-sd = sd
cohort-column-min = min
cohort-column-median = median
cohort-column-max = max
cohort-column-skewness = skewness

## Learning

cohort-learning-mean = mean
cohort-learning-fitted = curve fitted to the means
cohort-learning-one = one trainee
cohort-learning-none = No trainee has flown that many yet.
cohort-learning-figure =
    { $score }, { $count ->
        [one] one trainee
       *[other] { $count } trainees
    }
cohort-learning-note = Each curve is a fit of the power law of practice. The ring marks the prediction for the next repetition. The group curve is flatter than the individual trainees' curves.
cohort-learning-caption = group learning curves, fitted to the means
cohort-column-first-mean = first mean
cohort-column-last-mean = last mean
cohort-individual-too-many = { $count } trainees flew more than once. Above { $limit }, trainees are not shown individually; see progress.csv.
cohort-individual =
    { $trainee }, { $count ->
        [one] { $count } time
       *[other] { $count } times
    }

## Distributions instead of lists

cohort-pooled-note = { $count } trainees are too many to list. The figures show distributions; for individual data, see { $file }.
cohort-pooled-tasks = On-path share by task (%)
cohort-pooled-tasks-title = On-path share by task
cohort-pooled-tasks-caption = on-path share by task, %, only for trainees who attempted the task
cohort-pooled-crashes = Trainees by number of crashes; the line marks the mean
cohort-pooled-crashes-title = Histogram of crashes per trainee
cohort-pooled-crashes-caption = trainees by number of crashes
cohort-column-crashes-from = crashes, from
cohort-column-crashes-to = to
cohort-pooled-rating = Overall score (% of maximum) by self-rating (5 is best)
cohort-pooled-rating-title = Measured score by self-rating
cohort-pooled-rating-caption = measured score by self-rating (%)
# Predicates of sentences about a trainee.
cohort-contradiction-rated-too-high = rated their own performance { $own } of 5 but scored { $measured }%, which is in the bottom quarter
cohort-contradiction-rated-too-low = rated their own performance { $own } of 5 but scored { $measured }%, which is in the top quarter
cohort-contradiction-slow = felt no time pressure but flew for { $minutes } min, which is in the slowest quarter
cohort-contradiction-fast = felt time pressure but flew for { $minutes } min, which is in the fastest quarter
cohort-pooled-contradictions =
    { $count ->
        [one] { $count } contradiction is listed in contradictions.csv.
       *[other] { $count } contradictions are listed in contradictions.csv.
    }
cohort-column-self-rating = self-rating
cohort-column-low-whisker = low whisker
cohort-column-high-whisker = high whisker

## Repetitions

cohort-boxes = Box plots of { $score } by repetition
cohort-boxes-note = Boxes show the quartiles and the median; crosses show the mean. Whiskers extend to the most extreme values within 1.5 interquartile ranges of the box.
cohort-versus = { $earlier } vs. { $later }
cohort-tests-caption = paired t tests (later minus earlier repetition)
cohort-column-pairs = pairs
cohort-column-p-upper = p upper
cohort-column-p-lower = p lower
cohort-column-p-two = p two-tailed
cohort-column-p-holm = p two-tailed, Holm
cohort-column-beyond-error = trainees beyond error
cohort-homogeneity-caption = first sessions: trainees with repetitions vs. all others (low / middle / high scores)
cohort-column-with-repetitions = with repetitions
cohort-column-others = others
cohort-column-chi-squared = chi-squared

## Reliability

cohort-reliability-known = Estimated from the first { $repetitions } sessions of each trainee who flew that often. ICC(2,1) measures agreement between sessions, and ICC(3,1) measures whether the order of the trainees stays the same. A change that is smaller than the minimal detectable change is within the error of the measure. For the mean of n trainees, this limit is smaller by the square root of n.
cohort-reliability-unknown = The error of a measure can be estimated only if at least two trainees flew the job more than once.
cohort-reliability-caption = reliability of the measures
cohort-column-measure = measure
cohort-column-sessions = sessions
cohort-column-ceiling = at the ceiling (%)
cohort-column-trainees-repeating = trainees with repetitions

## Limitations

cohort-limitations =
    { $count ->
        [one] 1 limitation of these statistics
       *[other] { $count } limitations of these statistics
    }
cohort-limit-aided =
    { $count ->
        [one] 1 session was frozen or rewound, and is not compared
       *[other] { $count } sessions were frozen or rewound, and are not compared
    }
cohort-limit-pooled-forms = the forms { $forms } are pooled, as in the TASBID paper: a change between repetitions may be due to the difficulty of their defects
cohort-limit-few-answers =
    demand, strain, performance: only { $count ->
        [one] 1 trainee
       *[other] { $count } trainees
    } gave complete answers; with fewer than { $recommended }, the model can miss medium effects, so it describes only these trainees and does not generalize
cohort-limit-no-causal-model = demand, strain, performance: model could not be estimated: { $outcome }: { $reason }
cohort-limit-few-pairs =
    only { $count ->
        [one] 1 trainee
       *[other] { $count } trainees
    } flew { $repetitions } times; with fewer than { $recommended }, a paired test can miss medium effects
cohort-limit-imprecise =
    the reliability of the measures is based on { $count ->
        [one] { $count } trainee
       *[other] { $count } trainees
    }; with fewer than { $recommended }, it is imprecise
cohort-limit-no-reliability = no reliability of { $measure }: it has the same value in all sessions of these trainees
cohort-limit-no-comparison = { $score }, repetition { $later } vs. { $earlier }: no test possible: { $reason }
cohort-limit-no-homogeneity = { $score }: cannot compare the group with the other trainees: { $reason }
cohort-reason-too-few =
    only { $count ->
        [one] 1 value
       *[other] { $count } values
    }; at least { $needed } are required
cohort-reason-constant = all values are the same
cohort-reason-collinear = the predictors are collinear in this sample
