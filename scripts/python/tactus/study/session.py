"""One session of a participant: presents the trials and writes each to the journal before the next begins."""
import contextlib
import hashlib
import json
import pathlib
import shutil
import signal
import time

from tactus import signals
from tactus.refusal import Refusal
from tactus.study import bids_labels, formats, games, questions, stimuli, texts
from tactus.study.cluster_words import cluster_words, sees
from tactus.study.journal import Journal
from tactus.study.trial_runner_client import TrialRunnerClient
from tactus.study.live_cluster import LiveCluster
from tactus.study.plan import Plan
from tactus.study.simulated import Participant
from tactus.study.study_file import YES_OR_NO
from tactus.terminal import report

TASKS = {"synchrony": "sj", "order": "toj", "two_interval": "2ifc", "rating": "rating", "matching": "matching", "performance": "game"}
ESTIMATE_EVERY = 10      # trials; a fit takes 0.1 s
MAX_MISSED_IN_A_ROW = 10  # missed trials in a row; more: the apparatus does not suit the study (design)


def session_folder(study, options):
    name = options.participant if options.session == 1 else f"{options.participant}_session{options.session}"
    return pathlib.Path(options.out).absolute() / study.name / name


def resume(plan, answered):
    """Brings the plan to its state after these answers. Raises Refusal if they do not belong to this plan."""
    for entry in answered:
        trial = plan.next()
        level = list(trial.level) if trial is not None and isinstance(trial.level, tuple) else getattr(trial, "level", None)
        if trial is None or (trial.number, trial.condition.id, level) != (entry["trial"], entry["condition"], entry["level"]):
            raise Refusal(f"the journal's trial {entry['trial']} ({entry['condition']} at {entry['level']}) is not in this plan; resume with the version of Tactus that wrote it")
        plan.answered(trial, entry["yes"])


def run_session(study, options):
    """Runs or resumes a session; returns the exit status."""
    signals.handle([signal.SIGTERM], lambda *_: (_ for _ in ()).throw(KeyboardInterrupt()))
    folder = session_folder(study, options)
    plan = Plan(study, options.participant, options.seed)
    observer = "simulated" if options.simulated else "human"
    with Journal(folder) as journal:
        resumed = bids_labels.begin(journal, study=study.name, study_sha256=study.sha256, participant=options.participant, seed=plan.seed, observer=observer)
        with contextlib.suppress(shutil.SameFileError):  # resumed from the copy itself
            shutil.copyfile(study.path, folder / "study.xml")
        if journal.repaired:
            report(f"study: {journal.repaired}")
        resume(plan, journal.answered())
        for line in plan.describe():
            report(line)
        if journal.ended:
            formats.export(folder)  # the process may have been killed before its export
            report(f"study: this session ended after {plan.done} trials; analyse it: tactus study analyse {folder}")
            return 0
        if resumed:
            report(f"study: resumes after {plan.done} of {plan.expected_trials} trials")
        s = Session(study, options, plan, journal, folder, observer)
        try:
            s.run()
        finally:
            s.end()
            formats.export(folder)
        report(s.summary())
        if options.json:
            pathlib.Path(options.json).write_text(json.dumps(s.figures(), indent=2, ensure_ascii=False) + "\n", encoding="utf-8", errors="backslashreplace")
    return 0


class Session:
    def __init__(self, study, options, plan, journal, folder, observer):
        self.study, self.options, self.plan, self.journal, self.folder, self.observer = study, options, plan, journal, folder, observer
        self.cluster = self.runner = self.participant = self.player = None
        self.began, self.trials_done = time.monotonic(), 0
        self.trials_began = self.began  # set again after the start of the cluster and the instructions
        self.errors_ms, self.missed = [], 0

    # The cluster and its trial runner.

    def start(self):
        runs = self.folder / "runs"
        runs.mkdir(exist_ok=True)
        number = 1 + max((int(p.name[3:]) for p in runs.glob("run[0-9]*") if p.is_dir() and p.name[3:].isdigit()), default=0)
        out = runs / f"run{number}"
        report(f"study: starts the cluster, results in {out}")
        self.cluster = LiveCluster(out, cluster_words(self.study, self.options))
        self.cluster.wait_until_it_runs()
        if self.options.live is not None:
            page = self.cluster.page()
            if page is None and not (self.options.window or self.options.simulated):
                raise Refusal(f"the live page does not start, so the participant cannot answer; see {out}/logs/live_server.log, or use --window")
            if page is not None:
                report(f"study: the participant's page is {page}{'&' if '?' in page else '?'}participant")
                report(f"study: the experimenter's page is {page}")
        s = self.study.stimulus
        self.runner = TrialRunnerClient(out, None if self.options.device else (*s.rest_m, s.above_m), with_pictures=sees(self.study, self.options))
        if not self.runner.wait_for(lambda: self.runner.senses and self.runner.sim_ns is not None and all(x["state"] == 1 for x in self.runner.senses.values()), 60):
            raise Refusal(f"the senses are not ready after 60 s; see {out}/logs")
        if self.options.simulated:
            self.participant = Participant(self.study, self.options.participant, self.plan.seed, out, self.runner)

    def end(self):
        if self.runner is not None:
            self.runner.end()
        if self.cluster is not None:
            self.cluster.end()

    # Questions to the participant.

    def ask(self, question, trial=None):
        """Publishes a question and waits for its answer, without a time limit. A text longer than a screen is shown on several; the last one asks."""
        *before, last = texts.screens(question["text"])
        for text in before:
            self.read(text)
        progress = texts.fill(self.study.phrases["progress"], done=self.plan.done, trials=self.plan.expected_trials)[:texts.LONGEST_LINE]
        self.runner.answer = self.runner.asked = None
        self.runner.send(question={**question, "text": last, "hint": self.study.phrases[texts.HINTS[question["kind"]]], "progress": progress, "trial": trial.number if trial else 0,
                                   "condition": trial.condition.id[:texts.LONGEST_LINE] if trial else ""})
        while not self.runner.wait_for(lambda: self.runner.answer is not None or (self.participant and self.runner.asked is not None), 1):
            self.cluster.check()
        return self.runner.answer

    def answered(self, **answer):
        """Publishes the answer of a simulated participant."""
        self.runner.send(answer=answer)
        if not self.runner.wait_for(lambda: self.runner.answer is not None, 5):
            raise Refusal("trial_runner: did not accept the answer of the simulated participant; see its lines in the log of the run")
        return self.runner.answer

    def read(self, text):
        if self.participant is None:
            self.ask({"kind": "read", "text": text})

    # The session.

    def run(self):
        if self.study.task == "game" and self.options.simulated:
            self.player = games.live_player(self.study, report)
            return self.run_trials(games.play_simulated)
        self.start()
        for text in self.study.instructions:
            self.read(text)
        self.run_trials({"tap": stimuli.tap, "press": stimuli.press, "game": games.play}[self.study.task])

    def run_trials(self, stimulus):
        block = self.plan.block_of(self.plan.done) if self.plan.done else None
        in_a_row = 0
        self.trials_began = time.monotonic()
        while (trial := self.plan.next()) is not None:
            if self.options.most is not None and self.trials_done >= self.options.most:
                return
            if block is not None and trial.block != block:
                self.pause(trial)
            block = trial.block
            attempt = 1 + sum(e["kind"] == "trial" and e["trial"] == trial.number for e in self.journal.entries)
            observed = stimulus(self, trial, attempt) if self.study.task == "game" else stimulus(self.runner, self.study, trial, self.plan.draw(f"foreperiod {trial.number} {attempt}"))
            if self.study.task != "game":
                self.cluster.check()
            answer = None
            if not observed.missed:
                answer = self.answer(trial, attempt, observed)
            self.store(trial, attempt, observed, answer)
            in_a_row = in_a_row + 1 if observed.missed else 0
            if in_a_row >= MAX_MISSED_IN_A_ROW or attempt > self.study.repeats and observed.missed:
                raise Refusal(f"trial {trial.number} ({trial.condition.id} at {trial.level}) was missed {attempt} times ({observed.missed}); the apparatus does not meet "
                              "the tolerance of this study: see the summary of its run, and resume with the same command")
            self.trials_done += not observed.missed
        self.questionnaire(self.study.blocks)
        self.journal.append({"kind": "end"})
        if self.runner is not None:
            self.read(self.study.phrases["end"])  # all answers are already on the disk

    def answer(self, trial, attempt, observed):
        if self.study.task == "game":
            return {"choice": -1, "number": 0, "after_s": None, "by": "play"}
        question = questions.words(self.study, trial)
        if self.participant is None:
            return self.ask(question, trial)
        level = trial.level
        if trial.condition.kind == "asynchrony":
            level, observed.missed = self.participant.perceived_ms(observed)
            observed.sensed_ms = level
            if observed.missed:
                return None
        self.ask(question, trial)
        if self.study.response in YES_OR_NO:
            yes = self.participant.is_yes(trial, attempt, level, observed)
            return self.answered(choice=questions.choice_of(self.study, trial, yes))
        return self.answered(number=self.study.number[0]) if self.study.number else self.answered(choice=0)

    def store(self, trial, attempt, observed, answer):
        """Writes the trial to the journal and prints its line."""
        profile = self.study.profile(trial.condition, trial.level)
        presented = 1 + sum(e["kind"] == "trial" for e in self.journal.entries)
        row = {"participant_id": self.options.participant, "session": self.options.session, "block": trial.block, "trial": presented, "task": TASKS[self.study.response],
               "study": self.study.name, "condition": trial.condition.id, "observer": self.observer, "seed": self.plan.seed, "d_base_ms": self.study.base_delay_ms,
               "profile_sha256": hashlib.sha256(profile.encode()).hexdigest(), "question": questions.words(self.study, trial)["text"], "missed": int(bool(observed.missed)),
               "missed_reason": observed.missed, **trial.condition.row(trial.level), **observed.row}
        if self.cluster is not None:
            row["log_file"] = str((self.cluster.out / "run.lcmlog").relative_to(self.folder))
        if observed.soa_ms is not None:
            row.update(soa_achieved_ms=round(observed.soa_ms, 4), soa_uncertainty_ms=round(observed.uncertainty_ms, 4))
        response, yes = "", None
        if answer is not None:
            if self.study.task != "game":
                response, yes, more = questions.meaning(self.study, trial, answer)
                row.update(more, response_time=round(answer["after_s"], 4))
            row["response"] = response
        if observed.reached_N is not None:
            row["peak_force_n"] = round(observed.reached_N, 4)
        entry = {"kind": "trial", "trial": trial.number, "attempt": attempt, "block": trial.block, "condition": trial.condition.id, "question": self.study.response,
                 "level": list(trial.level) if isinstance(trial.level, tuple) else trial.level, "response": response, "yes": yes, "missed": observed.missed,
                 "by": answer["by"] if answer else "", "row": row}
        for name, value in (("sensed_ms", observed.sensed_ms), ("event", observed.event or None), ("stiffnesses_N_m", observed.stiffnesses_N_m or None)):
            if value is not None:
                entry[name] = value
        self.journal.append(entry)
        if observed.missed:
            self.missed += 1
        else:
            self.plan.answered(trial, yes)
            if observed.soa_ms is not None:
                self.errors_ms.append(observed.soa_ms - trial.level)
        self.report(trial, observed, response)

    def report(self, trial, observed, response):
        done, expected = self.plan.done, self.plan.expected_trials
        left_s = (time.monotonic() - self.trials_began) / max(1, self.trials_done + 1) * max(0, expected - done)
        words = f"trial {trial.number:4d} of {expected}  {trial.condition.words(trial.level)}"
        if observed.soa_ms is not None:
            words += f": {observed.soa_ms:.1f} +-{observed.uncertainty_ms:.1f} ms"
        words += f"  {observed.missed or response or observed.words()}  {left_s / 60:.0f} min left"
        if self.runner is not None and self.runner.senses:
            slow = [f"{n} {s['rate_Hz']:.0f}/{s['nominal_rate_Hz']:.0f} Hz" for n, s in self.runner.senses.items() if s["rate_Hz"] < 0.98 * s["nominal_rate_Hz"]]
            words += f"  slow: {', '.join(slow)}" if slow else ""
        report(words)
        if done and done % ESTIMATE_EVERY == 0:
            if self.runner is not None and self.runner.senses:
                report("  rates: " + ", ".join(f"{n} {s['rate_Hz']:.1f} Hz, {s['missed_ticks']} ticks missed" for n, s in sorted(self.runner.senses.items())))
            for name, estimate in self.plan.estimates().items():
                if estimate:
                    report(f"  {name}: " + ", ".join(f"{k} {v:.3g}" for k, v in estimate.items() if isinstance(v, float)))

    def pause(self, trial):
        if any(e["kind"] == "break" and e.get("before") == trial.number for e in self.journal.entries):
            return
        formats.export(self.folder)
        if self.study.questionnaire_at == "block":
            self.questionnaire(trial.block - 1)
        if self.participant is None and self.runner is not None:
            since = time.monotonic()
            self.ask({"kind": "read", "text": texts.fill(self.study.phrases["break"], block=trial.block - 1, blocks=self.study.blocks, seconds=f"{self.study.break_s:.0f}")})
            left_s = self.study.break_s - (time.monotonic() - since)
            if left_s > 0:
                self.runner.wait_for(lambda: False, left_s)
        self.journal.append({"kind": "break", "before": trial.number})

    def questionnaire(self, block):
        """Asks the items once, at the end of the session, or at the end of each block; then they are ITEM_blockN in the journal."""
        if self.runner is None:
            return
        known = {e["item"] for e in self.journal.entries if e["kind"] == "questionnaire"}
        for item in self.study.questionnaire:
            name = item.id if self.study.questionnaire_at == "end" else f"{item.id}_block{block}"
            if name in known:
                continue
            if self.participant is not None:
                continue  # a simulated participant has no answer to an item
            answer = self.ask(questions.of_item(item))
            self.journal.append({"kind": "questionnaire", "item": name, "answer": answer["number"] if item.step else item.choices[answer["choice"]]})

    def figures(self):
        e = sorted(abs(x) for x in self.errors_ms)
        at = lambda share: e[min(len(e) - 1, int(share * len(e)))] if e else None
        return {"study": self.study.name, "participant": self.options.participant, "observer": self.observer, "trials": self.plan.done, "expected": self.plan.expected_trials,
                "missed": self.missed, "asynchrony_error_p50_ms": at(0.5), "asynchrony_error_p95_ms": at(0.95), "seconds": round(time.monotonic() - self.began, 1),
                "estimates": self.plan.estimates() if self.plan.done else {}}

    def summary(self):
        f = self.figures()
        words = f"study: {f['trials']} of {f['expected']} trials done, {f['missed']} missed and repeated in this run"
        if self.errors_ms:
            words += f"; error of the asynchrony: {f['asynchrony_error_p50_ms']:.2f} ms (median), {f['asynchrony_error_p95_ms']:.2f} ms (95 %)"
        return words + f"; in {self.folder}"
