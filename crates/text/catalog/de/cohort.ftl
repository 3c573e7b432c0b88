## Cohort

cohort-title = Kohortenbericht
cohort-sections = Abschnitte
cohort-summary =
    { $trainees ->
        [one] { $trainees } Trainee
       *[other] { $trainees } Trainees
    }, { $sessions ->
        [one] { $sessions } Sitzung
       *[other] { $sessions } Sitzungen
    } mit { $scenarios }.
cohort-certified =
    Zertifiziert: { $certified } von { $sessions ->
        [one] { $sessions } Sitzung
       *[other] { $sessions } Sitzungen
    }.
cohort-group =
    { $trainees ->
        [one] { $trainees } Trainee flog
       *[other] { $trainees } Trainees flogen
    } mindestens { $repetitions }-mal.
cohort-section-limitations = Einschränkungen
cohort-section-distributions = Wertungen der ersten Sitzungen
cohort-section-people = Wertungen nach Trainee und Aufgabe
cohort-section-crashes = Kollisionen
cohort-section-reliability = Zuverlässigkeit der Messgrößen
cohort-section-repetitions = Wiederholungen
cohort-section-learning = Lernkurven
cohort-section-individual = Fortschritt einzelner Trainees
cohort-section-answers = Antworten
cohort-section-self-rating = Selbsteinschätzung und gemessene Wertung
cohort-section-causal = Anforderung, Belastung, Leistung
cohort-section-files = Tabellen herunterladen
cohort-files-note = Tabellen mit einer Zeile je Trainee sind nicht eingebettet, weil die Seite sonst zu groß wäre. { $command } schreibt { $files }.

## Answers

cohort-answer-strongly-agree = stimme voll zu
cohort-answer-agree = stimme zu
cohort-answer-neutral = neutral
cohort-answer-disagree = stimme nicht zu
cohort-answer-strongly-disagree = stimme gar nicht zu
cohort-answers-first =
    Alle ersten Sitzungen (bis zu { $count ->
        [one] { $count } Antwort
       *[other] { $count } Antworten
    })
cohort-answers-first-title = Antworten aus allen ersten Sitzungen
cohort-answers-later = Trainees mit wiederholten Sitzungen: Wiederholung { $repetition }
cohort-answers-later-title = Antworten zu Wiederholung { $repetition }
cohort-self-rating-correlation =
    Spearman-Korrelation von Selbsteinschätzung und Gesamtwertung: { $correlation }, { $trainees ->
        [one] { $trainees } Trainee
       *[other] { $trainees } Trainees
    }.
cohort-self-rating-caption = Selbsteinschätzung und gemessene Wertung
cohort-column-self-rating-scale = Selbsteinschätzung (1 bis 5)
cohort-column-measured = gemessene Wertung (%)
cohort-column-trainee = Trainee
cohort-column-trainees = Trainees
cohort-column-completion = Vollständigkeit
cohort-column-certification = Zertifizierung

## Causal model

cohort-causal-intro = Erhöht die Anforderung die Belastung, verringert die Belastung die Leistung, und schwächen Rückmeldungen im Flug die Wirkung der Anforderung auf die Belastung ab? Geschätzt aus den ersten Sitzungen aller Trainees, die den Fragebogen beantwortet haben.
cohort-causal-none = Keine Schätzung möglich: Zu wenige Trainees haben den Fragebogen beantwortet, oder ihre Antworten unterscheiden sich nicht. Empfohlen sind mindestens { $count } Trainees mit vollständigen Antworten.
cohort-causal-count =
    { $count ->
        [one] { $count } Trainee mit vollständigen Antworten.
       *[other] { $count } Trainees mit vollständigen Antworten.
    }
cohort-causal-caution = Bei weniger als { $recommended } kann das Modell mittlere Effekte übersehen. Es beschreibt nur diese Trainees und lässt sich nicht verallgemeinern.
cohort-causal-diagram = Pfaddiagramm; gestrichelte Pfeile zeigen Effekte, deren 95-%-Konfidenzintervall die Null enthält
cohort-causal-diagram-region = Kausalmodell
cohort-causal-diagram-title = Anforderung, Belastung, Leistung und Rückmeldungen
cohort-causal-scales = Anforderung, Belastung und Rückmeldungen werden von 1 bis 5 bewertet; die Leistung ist die Gesamtwertung in Prozent des Höchstwerts.
cohort-causal-indirect = Indirekter Effekt einer Einheit Anforderung auf die Leistung über die Belastung, nach Nutzen der Rückmeldungen, mit 95-%-Konfidenzintervallen
cohort-causal-indirect-region = Indirekte Effekte
cohort-causal-indirect-axis = % der Gesamtwertung je Einheit Anforderung
cohort-causal-indirect-title = Indirekter Effekt der Anforderung nach Nutzen der Rückmeldungen
cohort-causal-low = geringer Nutzen
cohort-causal-mean = mittlerer Nutzen
cohort-causal-high = hoher Nutzen
cohort-causal-level = { $level } ({ $feedback })
cohort-causal-moderation = Moderation: Änderung des Effekts je Einheit Rückmeldungen
cohort-causal-effects-caption = indirekter Effekt der Anforderung auf die Leistung über die Belastung, mit Bootstrap-Konfidenzintervallen
cohort-causal-coefficients-caption = Koeffizienten der beiden Regressionen
cohort-column-feedback-level = Stufe der Rückmeldungen
cohort-column-feedback = Rückmeldungen
cohort-column-effect = Effekt (%)
cohort-column-ci-lower = Untergrenze des 95-%-KI
cohort-column-ci-upper = Obergrenze des 95-%-KI
cohort-column-outcome = Zielgröße
cohort-column-term = Term
cohort-column-estimate = Schätzwert
cohort-column-standard-error = Standardfehler
cohort-term-intercept = Achsenabschnitt
cohort-term-demand = Anforderung
cohort-term-strain = Belastung
cohort-term-performance = Leistung
cohort-term-interaction = Anforderung × Rückmeldungen

## First sessions

cohort-histogram = Histogramm: { $score }; die Linie zeigt den Mittelwert
cohort-first-caption = erste Sitzungen
cohort-no-tasks = keine Aufgaben
cohort-individuals-caption = erste Sitzung jedes Trainees
cohort-shares = Anteil auf der Bahn nach Trainee und Aufgabe
cohort-shares-figure = Anteil der Zeit auf der Bahn
cohort-crashes-count =
    { $count ->
        [one] { $count } Kollision
       *[other] { $count } Kollisionen
    } in den ersten Sitzungen.
cohort-crashes-by-object = Nach Objekt
cohort-crashes-by-kind-title = Kollisionen nach Art
cohort-crashes-by-task = Nach Aufgabe
cohort-crashes-by-task-title = Kollisionen nach Aufgabe
cohort-crashes-by-trainee = Nach Trainee
cohort-crashes-by-trainee-title = Kollisionen nach Trainee
cohort-crashes-outside = außerhalb
cohort-crashes-all = alle
cohort-column-mean = Mittelwert
cohort-column-sd = Standardabw.
cohort-column-min = Min.
cohort-column-median = Median
cohort-column-max = Max.
cohort-column-skewness = Schiefe

## Learning

cohort-learning-mean = Mittelwert
cohort-learning-fitted = an die Mittelwerte angepasste Kurve
cohort-learning-one = einzelne Trainees
cohort-learning-none = So oft ist noch niemand geflogen.
cohort-learning-figure =
    { $score }, { $count ->
        [one] 1 Trainee
       *[other] { $count } Trainees
    }
cohort-learning-note = Jede Kurve ist eine Anpassung des Potenzgesetzes der Übung. Der Ring zeigt die Vorhersage für die nächste Wiederholung. Die Kurve der Gruppe ist flacher als die der einzelnen Trainees.
cohort-learning-caption = Lernkurven der Gruppe, an die Mittelwerte angepasst
cohort-column-first-mean = erster Mittelwert
cohort-column-last-mean = letzter Mittelwert
cohort-individual-too-many = { $count } Trainees sind mehrmals geflogen. Bei mehr als { $limit } werden sie nicht einzeln gezeigt; siehe progress.csv.
cohort-individual = { $trainee }, { $count }-mal

## Distributions instead of lists

cohort-pooled-note = { $count } Trainees sind zu viele für eine Liste. Die Abbildungen zeigen Verteilungen; die Daten der einzelnen Trainees enthält { $file }.
cohort-pooled-tasks = Anteil auf der Bahn nach Aufgabe (%)
cohort-pooled-tasks-title = Anteil auf der Bahn nach Aufgabe
cohort-pooled-tasks-caption = Anteil auf der Bahn nach Aufgabe, %, nur Trainees, die die Aufgabe begonnen haben
cohort-pooled-crashes = Trainees nach Zahl der Kollisionen; die Linie zeigt den Mittelwert
cohort-pooled-crashes-title = Histogramm der Kollisionen je Trainee
cohort-pooled-crashes-caption = Trainees nach Zahl der Kollisionen
cohort-column-crashes-from = Kollisionen, von
cohort-column-crashes-to = bis
cohort-pooled-rating = Gesamtwertung (% des Höchstwerts) nach Selbsteinschätzung (5 ist am besten)
cohort-pooled-rating-title = Gemessene Wertung nach Selbsteinschätzung
cohort-pooled-rating-caption = gemessene Wertung nach Selbsteinschätzung (%)
cohort-contradiction-rated-too-high = bewertete die eigene Leistung mit { $own } von 5, liegt aber mit { $measured }% im untersten Viertel
cohort-contradiction-rated-too-low = bewertete die eigene Leistung mit { $own } von 5, liegt aber mit { $measured }% im obersten Viertel
cohort-contradiction-slow = spürte keinen Zeitdruck, flog aber { $minutes } min und gehört damit zum langsamsten Viertel
cohort-contradiction-fast = spürte Zeitdruck, flog aber nur { $minutes } min und gehört damit zum schnellsten Viertel
cohort-pooled-contradictions =
    { $count ->
        [one] { $count } Widerspruch steht in contradictions.csv.
       *[other] { $count } Widersprüche stehen in contradictions.csv.
    }
cohort-column-self-rating = Selbsteinschätzung
cohort-column-low-whisker = unterer Whisker
cohort-column-high-whisker = oberer Whisker

## Repetitions

cohort-boxes = Boxplots nach Wiederholung: { $score }
cohort-boxes-note = Die Kästen zeigen die Quartile und den Median, die Kreuze den Mittelwert. Die Whisker reichen bis zu den äußersten Werten innerhalb von 1.5 Interquartilsabständen vom Kasten.
cohort-versus = { $earlier } gegen { $later }
cohort-tests-caption = gepaarte t-Tests (spätere minus frühere Wiederholung)
cohort-column-pairs = Paare
cohort-column-p-upper = p oberseitig
cohort-column-p-lower = p unterseitig
cohort-column-p-two = p zweiseitig
cohort-column-p-holm = p zweiseitig, Holm
cohort-column-beyond-error = Trainees außerhalb des Messfehlers
cohort-homogeneity-caption = erste Sitzungen: Trainees mit Wiederholungen gegen alle anderen (niedrige / mittlere / hohe Wertungen)
cohort-column-with-repetitions = mit Wiederholungen
cohort-column-others = andere
cohort-column-chi-squared = Chi-Quadrat

## Reliability

cohort-reliability-known = Geschätzt aus den ersten { $repetitions } Sitzungen aller Trainees, die so oft geflogen sind. ICC(2,1) misst die Übereinstimmung der Sitzungen, ICC(3,1), ob die Reihenfolge der Trainees gleich bleibt. Eine Änderung, die kleiner ist als die kleinste nachweisbare Änderung, liegt innerhalb des Messfehlers. Für den Mittelwert von n Trainees ist diese Grenze um die Wurzel aus n kleiner.
cohort-reliability-unknown = Der Messfehler lässt sich nur schätzen, wenn mindestens zwei Trainees den Auftrag mehrmals geflogen sind.
cohort-reliability-caption = Zuverlässigkeit der Messgrößen
cohort-column-measure = Messgröße
cohort-column-sessions = Sitzungen
cohort-column-ceiling = am Höchstwert (%)
cohort-column-trainees-repeating = Trainees mit Wiederholungen

## Limitations

cohort-limitations =
    { $count ->
        [one] 1 Einschränkung dieser Statistik
       *[other] { $count } Einschränkungen dieser Statistik
    }
cohort-limit-aided =
    { $count ->
        [one] 1 Sitzung wurde eingefroren oder zurückgespult und wird nicht verglichen
       *[other] { $count } Sitzungen wurden eingefroren oder zurückgespult und werden nicht verglichen
    }
cohort-limit-pooled-forms = die Varianten { $forms } sind wie im TASBID-Artikel zusammengefasst: Eine Änderung zwischen Wiederholungen kann an der Schwierigkeit ihrer Schäden liegen
cohort-limit-few-answers =
    Anforderung, Belastung, Leistung: Nur { $count ->
        [one] 1 Trainee hat
       *[other] { $count } Trainees haben
    } vollständig geantwortet; bei weniger als { $recommended } kann das Modell mittlere Effekte übersehen, beschreibt also nur diese Trainees und lässt sich nicht verallgemeinern
cohort-limit-no-causal-model = Anforderung, Belastung, Leistung: Das Modell konnte nicht geschätzt werden: { $outcome }: { $reason }
cohort-limit-few-pairs =
    Nur { $count ->
        [one] 1 Trainee ist
       *[other] { $count } Trainees sind
    } { $repetitions }-mal geflogen; bei weniger als { $recommended } kann ein gepaarter Test mittlere Effekte übersehen
cohort-limit-imprecise =
    Die Zuverlässigkeit der Messgrößen beruht auf { $count ->
        [one] { $count } Trainee
       *[other] { $count } Trainees
    }; bei weniger als { $recommended } ist sie ungenau
cohort-limit-no-reliability = Keine Zuverlässigkeit für { $measure }: In allen Sitzungen dieser Trainees ist der Wert gleich
cohort-limit-no-comparison = { $score }, Wiederholung { $later } und { $earlier }: kein Test möglich: { $reason }
cohort-limit-no-homogeneity = { $score }: Die Gruppe lässt sich nicht mit den übrigen Trainees vergleichen: { $reason }
cohort-reason-too-few =
    nur { $count ->
        [one] 1 Wert
       *[other] { $count } Werte
    }, mindestens { $needed } nötig
cohort-reason-constant = alle Werte sind gleich
cohort-reason-collinear = die Prädiktoren sind in dieser Stichprobe kollinear
