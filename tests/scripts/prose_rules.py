"""The rules of check_prose.py, as data: refused constructions, old names, old folders and files."""

# Subjects. A program that "tells" or "knows" is an offence; a person may.
PROGRAM = (r"(?:\w+_(?:node|time)|nodes?|programs?|process(?:es)?|simulations?|senses?|modalit(?:y|ies)|renderers?|recorders?|relays?|"
           r"servers?|clients?|receivers?|senders?|publishers?|subscribers?|conductor|drivers?|loops?|buffers?|queues?|scenes?|"
           r"logs?|messages?|reports?|summar(?:y|ies)|profiles?|operators?|policy|bus|kernel|thread|callback|solver|detector|"
           r"compiler|script|command|doctor|table|page|wall|display|estimator|tracker|sampler|model|host|site)")
PERSON = (r"\b(?:you|we|persons?|people|users?|participants?|players?|readers?|experimenters?|observers?|authors?|engineers?|"
          r"callers?|subjects?|listeners?|developers?|contributors?|reviewers?)\b[^.;:]*$")
NOT_AFTER_PERSON = {"unless_before": PERSON}

# (rule, pattern, what is wrong, what to write[, options]). A space in a pattern is any white space, also the end of a line. Patterns
# ignore case. Options: unless_before: no offence when this matches the part of the sentence before the match.
RULES = [
    ("anew", r"\banew\b", "archaic", '"again", or the verb "restart", "recompute", "reload"'),
    ("whoever", r"\b(?:who(?:m)?(?:so)?ever)\b", "a free relative", 'name the subject: "any receiver", "the sender", "the user"'),
    ("whatever", r"\bwhat(?:so)?ever\b", "a free relative", '"regardless of ...", "any ...", "in all cases"'),
    ("nobody", r"\b(?:nobody|somebody|anybody|everybody)\b", "a person as a subject for a program, or none in particular",
     'name it: "no subscriber", "no process", "the user", "a participant"'),
    ("so-many", r"\b(?:so (?:many|few|late|early|often)(?! \w+ that\b)(?! that\b)|(?:at most|at least|for|within|after|every|since|"
     r"only|lasts?|last|it|takes?) so (?:long|much|far)(?! as\b)(?! that\b))",
     '"so many", "so long" for a number', 'the number, its name, or "the same number of"'),
    ("what-subject", r"(?:\A|(?<=[.:;!?]\s)|(?<=\n\n))what (?!to\b|if\b|about\b|next\b|changed\.|kind\b)[\w'`-]+[^.;?!]*(?:[.;!]|\Z)",
     "a free relative as the subject, or as a title", 'a noun: "Late messages are dropped"'),
    ("who-subject", r"(?:\A|(?<=[.:;!?]\s)|(?<=\n\n))whom? (?!to\b|am\b)[\w'`-]+[^.;?!]*(?:[.;!]|\Z)",
     "a free relative as the subject, or as a title", 'a noun: "A receiver that ...", "The caller"'),
    ("what-object", r"\b(?:of|from|by|to|with|for|than|as|and|in|at|into|beside|after|before|over|like|through|under|per) what "
     r"(?:is|are|was|were|has|have|had|it|they|he|she|a|an|the|its|one|others?|each|comes?|came|arrives?|lies|stands?|moves?|"
     r"happens?|happened|remains?|rests?|can|cannot|must|may|would|does|do|did|follows?|precedes)\b",
     "a free relative as the object", 'a noun: "of the received samples"',
     {"unless_before": r"\b(?:depend\w*|according|look(?:s|ed)?|ask(?:s|ed)?|question|idea|know\w*|see|say\w*|print\w*|describ\w*)$"}),
    ("owe", r"\b(?:ow(?:e|es|ed)|owing(?! to\b)|debts?)\b", "a metaphor of debt", '"expected", "pending", "remaining", "must present"'),
    ("fate", r"\bfates?\b", "a metaphor", '"outcome"'),
    ("told", r"\btold\b", "programs are not told", '"receives", "is set", "is published", "is reported"; "distinguished"', NOT_AFTER_PERSON),
    ("tells", r"\btells\b", "programs do not tell", '"publishes", "prints", "reports", "shows"; "distinguishes"', NOT_AFTER_PERSON),
    ("tell", r"(?:\b(?:to|can|cannot|not|must|may|could|will|would|that|which|it|" + PROGRAM + r") tell\b|\btell \w+ apart\b|\btell apart\b)",
     "programs do not tell", '"publish", "print", "report"; "distinguish"', NOT_AFTER_PERSON),
    ("hear", r"\b(?:hear(?:s|d|ing)? (?:of|each other|nothing of|also|it say)\b|(?:bus|" + PROGRAM +
     r") (?:never |no longer |does not |do not |has not |have not |has |have )?(?:hears?|heard)\b|"
     r"(?:last|was|were|been|is|are) (?:\w+ )?heard of\b)",
     "programs do not hear", '"receive", "receive from"', {"unless_before": PERSON}),
    ("knows", r"\b(?:(?:it|that|which|also|now|itself|" + PROGRAM + r") (?:knows|wants|minds|wishes|believes|thinks|likes)|"
     r"(?:" + PROGRAM + r") (?:do(?:es)? not |cannot |must |no longer )?(?:know|want|wish|believe|think)|who (?:knows|wants))\b",
     "programs do not know or want", '"stores", "has", "requires", "requests"'),
    ("says", r"\b" + PROGRAM + r" (?:itself |also |then |now |that )?(?:says|speaks)\b", "programs do not say",
     '"prints", "reports", "logs", "states", "specifies"'),
    ("he", r"\b(?:he|his|him|himself|she|herself)\b", "a pronoun for one sex", '"they", "the user", "the participant"'),
    ("go-on", r"\b(?:go|goes|went|going|gone) on\b(?! (?:the|a|an|each|every|one|this|top|port|to|its|another|\d)\b)", "a phrasal verb",
     '"continue", "resume"'),
    ("lets-go-on", r"\b(?:lets? (?:\w+ ){1,2}go on|lets? go of)\b", "a phrasal verb", '"resumes", "releases"'),
    ("stand-in", r"\b(?:stands?|stood|standing) in for\b", "a phrasal verb", '"replaces", "simulates", "represents"'),
    ("give-back", r"\b(?:gives?|gave|given|giving) back\b", "a phrasal verb", '"return", "release", "restore"'),
    ("let-in", r"\b(?:is|are|was|were|be|been|being|not) let (?:in|through|pass)\b|\blets? (?:\w+ )?in\b(?= [.,;]|[.,;])", "a phrasal verb", '"accept", "admit"'),
    ("look-on", r"\blook(?:s|ed)? (?:on|upon)\b(?! (?:the|a|an)\b)", "a phrasal verb", '"monitor", "inspect"'),
    ("one-of-lives", r"\b(?:(?:another|a new|each|every|one|same|this|that) li(?:fe|ves) of|births?|(?:a|the|its) lives? of (?:a|the) (?:contact|process|node|sender|simulation))\b",
     "a metaphor of life", '"incarnation" of a process; "begin" and "end" of a contact', {"unless_before": r"\bdate of$"}),
    ("nothing-that", r"\bnothing (?:is|was|of it is|of that is) (?!(?:in|on|at)\b)[^.;,:]{0,60}\bthat\b", "an inverted negative", "state it positively, subject first"),
    ("cleft", r"\bit (?:is|was) (?:the|a|an|this|these|what|not (?:the|a|an)) (?!(?:last|first|only|one|newest|oldest|latest|same)\b)[^.;,:?]{1,50}\b(?:that|who|which)\b", "a cleft sentence", 'the subject first: "The simulation decides"'),
    ("lest", r"\b(?:lest|hitherto|henceforth|whence|thence|whither|wherein|naught|nought|withal|ere|betwixt)\b", "archaic", "a plain word"),
    ("worse", r"\bmak(?:e|es|ing) (?:\w+ ){0,3}worse\b", "not the term of the field", '"degrade"', {"unless_before": r"\bnot$"}),
    ("turn", r"\b(?:each|every|per|one|its own|this|the next|the last|a whole) turn\b(?= (?:that|takes|reads|of (?:a|the|its) (?:loop|node)|"
     r"begins|ends|is (?:late|skipped|over))|[.,;])|\bturns? of (?:a|the|its) (?:loop|node)\b", "an ambiguous word", '"tick", "iteration", "block" or "frame"'),
    ("bear", r"\b(?:bears|borne|bore) (?:its|the|a|no|that) names?\b|\bbears (?:it|them)\b", "a metaphor", '"is named", "tolerates"'),
    ("the-one-who", r"\b(?:out of itself|of itself alone|the one who)\b", "hard to read", "a noun"),
    ("without-a-word", r"\bwithout a word\b", "an idiom", '"silently", "without output"'),
    ("in-the-place", r"\bin (?:the|its) (?:place|stead) of\b", "archaic", '"instead of", "replaces"'),
]

# Every match of a rule contains one of these; searching for them first saves time.
NEEDS = {"anew": "anew", "whoever": "ever", "whatever": "ever", "nobody": "body", "so-many": "so", "what-subject": "what", "who-subject": "who",
         "what-object": "what", "owe": "ow debt", "fate": "fate", "told": "told", "tells": "tells", "tell": "tell", "hear": "hear",
         "knows": "know want mind wish believ think like", "says": "says speaks", "go-on": "go went", "lets-go-on": "let",
         "stand-in": "stand stood", "give-back": "back", "let-in": "let", "look-on": "look", "one-of-lives": "life live birth",
         "nothing-that": "nothing", "cleft": "that who which", "worse": "worse", "turn": "turn", "bear": "bear bore",
         "without-a-word": "word", "in-the-place": "place stead"}

# (old name, new name, where): whole words in code, without comments and strings. Where: a prefix of the path, also below tests/.
NAMES = [
    ("How", "SampleStatus; ClockSource in sender_clock.h", "sync/"), ("Let", "Delivered", "sync/"), ("Held", "StreamSlot", "sync/"),
    ("Sense", "ModalityEndpoint", ""), ("Declaration", "NodeDescriptor", ""), ("AskedQuestion", "CurrentQuestion", ""),
    ("Opening", "BackgroundTask", ""), ("WholeFile", "AtomicFile", ""), ("DatedEvents", "TimestampedEvents", ""),
    ("LogAges", "LogTimeRanges", ""), ("OriginFinder", "LogClockDetector", ""), ("SimFollower", "SimClockTracker", ""),
    ("Follow", "TrackResult", "sync/"), ("OneWayClock", "OneWayOffsetEstimator", ""), ("BusyGuard", "OverrunGuard", ""),
    ("InPhase", "ScopedPhaseTimer", ""), ("still_here", "heartbeat", ""), ("renew", "begin_incarnation", ""), ("hear_also", "attach", ""),
    ("Stack", "OperatorChain", "sync/"), ("Why", "DropReason", "sync/"), ("Item", "StreamItem", "sync/"), ("Waiting", "DelayQueue", "sync/"),
    ("Verdict", "Decision", "sync/"), ("delay_what_is_on_its_way", "log_in_flight_delays", ""), ("Needs", "LatencyDemand", "sync/"),
    ("Thinner", "Decimator", ""), ("YoungEvents", "EventRepeater", ""), ("welcome", "request_full_state", ""),
    ("Ways", "SweptTrajectories", "sim_node/"), ("look", "detect_contacts", "sim_node/behaviour/"), ("look", "detect_contacts", "sim_node/dual/"), ("UnseenWork", "PendingEnergyEstimator", ""),
    ("ContactBook", "ContactImpulses", ""), ("OwedBegins", "PendingOnsets", ""), ("Handover", "ForceCrossfade", ""),
    ("pose_programme", "pose_qp", ""), ("Choice", "NodeConfig", "haptic_node/"), ("Choice", "NodeConfig", "thermal_node/"),
    ("choose", "resolve_config", "haptic_node/choice"), ("choose", "resolve_config", "thermal_node/"), ("Crossing", "CallbackQueues", "audio_node/"),
    ("Orders", "RenderCommand", "audio_node/"), ("Heard", "ExposureMeter", "audio_node/"), ("Place", "SourcePosition", "audio_node/"),
    ("Rub", "RecordedContact", "audio_node/"), ("Stage", "RenderOutput", "visual_node/"), ("WallTalk", "WallSync", ""),
    ("LiveDesk", "WindowControls", ""), ("Station", "PageSession", ""), ("near_names", "spelling_suggestions", ""),
    ("news", "new_messages or take_status_change()", ""), ("note", "status_text", "sync/"), ("tell", "publish() or report()", ""),
    ("hear", "on_message", ""), ("hear_from", "set_listener", ""),
]
# (pattern of an identifier, new name). After the whole words.
NAME_PATTERNS = [
    (r"kMost[A-Z0-9]\w*", "kMax..."), (r"at_most(?:_\w+)?", "max_..."), (r"MOST_\w+", "MAX_..."), (r"most_\w+", "max_..."),
    (r"told_\w*|\w+_told_?|told", "last_published_..."), (r"\w*anew\w*", "again or restart"), (r"owed_?|\w+_owed_?|owed_\w+|kOwed\w*|Owed\w*", "expected_..."),
    (r"(?:k)?[Ff]ate[A-Z_s]?\w*", "outcome"), (r"\w*(?:[Ww]hoever|[Nn]obody|[Ss]omebody)\w*", "a name of the thing"),
]
FOLDERS = {"scripts/supervise": "launch", "scripts/spread": "cluster", "scripts/fitness": "doctor", "scripts/conductor": "trial_runner",
           "scripts/participant": "simulated_player", "scripts/modes": "modal_analysis", "scripts/evaluation": "report",
           "scripts/renderings": "rerender", "scripts/agreement": "virtual_time_check"}
FILES = {"sync/how.h": "sample_status.h", "sync/sense.h": "endpoint.h", "sync/asking.h": "request_reply.h", "lcmtypes/near_names.h": "spelling_suggestions.h",
         "sync/chance.h": "keyed_random.h", "haptic_node/turns.h": "rotation_math.h"}
