"""Questions to a participant as text, and the interpretation of the answers."""

from tactus.study import texts


def words(study, trial):
    """{kind, text, choices, ...}: question of the trial runner after a trial."""
    spoken = [study.phrases[s] for s in trial.condition.senses]
    fill = lambda text: texts.fill(text, a=spoken[0], b=spoken[1]) if spoken else text
    if study.number:
        low, high, step = study.number
        return {"kind": "number", "text": fill(study.question), "choices": [fill(c) for c in study.choices] if len(study.choices) == 2 else [], "lowest": low, "highest": high, "step": step}
    return {"kind": "choice", "text": fill(study.question), "choices": [fill(c) for c in study.choices]}


def of_item(item):
    if item.step:
        return {"kind": "number", "text": item.text, "choices": list(item.choices), "lowest": item.lowest, "highest": item.highest, "step": item.step}
    return {"kind": "choice", "text": item.text, "choices": list(item.choices)}


def meaning(study, trial, answer):
    """(response as text, yes for the procedure or None, columns of the trial table) of an answer."""
    if study.number:
        return f"{answer['number']:g}", None, {"answer_value": answer["number"]}
    choice = answer["choice"]
    if study.response == "synchrony":
        return ("yes" if choice == 0 else "no"), choice == 0, {}
    if study.response == "order":  # a level is t(b) - t(a): above 0, a came first
        return trial.condition.senses[choice], choice == 0, {"correct": int((choice == 0) == (trial.level > 0))} if trial.level else {}
    if study.response == "two_interval":
        right = choice == trial.degraded_interval
        return ("first", "second")[choice], right, {"correct": int(right)}
    return study.choices[choice], None, {"answer_value": choice + 1}


def choice_of(study, trial, yes):
    """Index of the choice that means yes or no, for a simulated participant."""
    if study.response == "two_interval":
        return trial.degraded_interval if yes else 1 - trial.degraded_interval
    return 0 if yes else 1
