"""How a command that works alone ends: its exit status, and one line for an error."""
from tactus import terminal
from tactus.refusal import Refusal, sentence_of


def status(name, run):
    """Exit status of run(): 1 after an error, which is printed in one sentence; 130 after Ctrl-C. name: of the command, for the line."""
    try:
        return run()
    except KeyboardInterrupt:
        terminal.report_refusal(f"{name}: interrupted")
        return 130
    except Refusal as refusal:
        terminal.report_refusal(f"{name}: {refusal}")
    except OSError as error:
        terminal.report_refusal(f"{name}: {sentence_of(error)}")
    return 1
