"""Totals of the test programs in a log of ctest."""
import re

SUMMARY = re.compile(r"^\s*\d+% tests passed, (\d+) tests? failed out of (\d+)", re.M)
SKIPPED = re.compile(r"^\s*\d+ - .*\((?:Skipped|Disabled)\)", re.M)
FAILED = re.compile(r"^\s*\d+ - (.*?) \((?:Failed|Timeout|SEGFAULT|Not Run|Subprocess aborted|Bus error|ILLEGAL|OTHER_FAULT|Exit code[^)]*|Child aborted)\)", re.M)


def totals(text):
    """{"passed": n, "failed": n, "skipped": n, "names": failed tests} of all runs of ctest in a text. A test that failed and passed when it
    ran once more, alone, counts as it was the first time; it is named."""
    failed = total = 0
    for summary in SUMMARY.finditer(text):
        if re.search(r"^test: the failed tests run again, alone$", text[:summary.start()], re.M):
            continue
        failed += int(summary[1])
        total += int(summary[2])
    skipped = len(SKIPPED.findall(text))
    return {"passed": total - failed - skipped, "failed": failed, "skipped": skipped, "names": list(dict.fromkeys(FAILED.findall(text)))}


def sentence(found):
    return f"{found['passed']} passed, {found['failed']} failed, {found['skipped']} skipped"
