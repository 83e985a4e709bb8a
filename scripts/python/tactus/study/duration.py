"""Estimated duration of a session in parts: the apparatus by its constants, the participant by assumed times."""

from tactus.study import stimuli

IN_FORCE_S = 0.15  # a sense reports its profile at 10 Hz: half a period, plus the transport both ways
AFTER_S = 0.34     # a sense reports twice, 20 ms apart; then the hand returns (stimuli.py). The sums agree with live sessions to 0.1 s a trial
APPROACH_S = 0.5   # of the hand to the surface before a press, and back after it (scripts/trial_runner/hand.cpp)
ANSWER_S = 1.5     # design: a choice between two, at leisure
NUMBER_S = 4.0     # design: a slider
BETWEEN_GAMES_S = 5.0  # design: the participant confirms, and the simulation is reset
ITEM_S = 5.0       # design: to answer an item of a questionnaire after reading it
WORDS_A_SECOND = 238 / 60  # silent reading of texts: Brysbaert 2019, Journal of Memory and Language 109:104047


def reading(texts):
    return sum(len(text.split()) for text in texts) / WORDS_A_SECOND


def of_trial(study):
    """[(part, s)] of one trial; asynchronies by their mean over the levels."""
    s = study.stimulus
    ready = IN_FORCE_S + stimuli.SETTLES_S + sum(stimuli.FOREPERIOD_S) / 2
    answer = ("answer", NUMBER_S if study.number else ANSWER_S)
    if study.task == "game":
        return [("game, at the most", s.limit_s), ("between games", BETWEEN_GAMES_S)]
    if study.task == "press":
        return [("profiles and foreperiods", 2 * ready), ("presses", 2 * (s.period_s * s.times + 2 * APPROACH_S)), answer]
    levels = [abs(level) for condition in study.conditions for level in condition.levels]
    return [("profile and foreperiod", ready), ("base delay", study.base_delay_ms / 1e3), ("asynchrony", sum(levels) / len(levels) / 1e3), ("reports, hand back", AFTER_S), answer]


def of_session(study, trials):
    """[(part, s)] of a session without missed trials."""
    items = len(study.questionnaire) * (study.blocks if study.questionnaire_at == "block" else 1)
    asked = items * ITEM_S + items / max(1, len(study.questionnaire)) * reading(i.text for i in study.questionnaire)
    parts = [("instructions", reading(study.instructions)), *((part, trials * seconds) for part, seconds in of_trial(study)),
             ("breaks", (study.blocks - 1) * study.break_s), ("questionnaire", asked)]
    return [(part, seconds) for part, seconds in parts if seconds > 0]
