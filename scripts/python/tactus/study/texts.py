"""Texts that a study shows to its participant, in any language: their characters, their length, and their screens."""
import re
import unicodedata

from tactus.refusal import Refusal

LONGEST_SCREEN, LONGEST_CHOICE, LONGEST_LINE = 600, 40, 64  # characters: lcmtypes/types/control/question_t.lcm
LONGEST_TEXT = 6000  # characters; design: ten screens. A longer text is divided into several elements
SPOKEN = {"haptic": "touch", "audio": "sound", "visual": "picture", "thermal": "warmth"}
# Texts that the session shows by itself; <phrase of=""> of a study file replaces them. The words in braces are filled in.
# A hint names the keys below a question; empty: the window and the page write it in English.
HINTS = {"read": "hint_read", "choice": "hint_choice", "number": "hint_number"}
PHRASES = {**SPOKEN, **dict.fromkeys(HINTS.values(), ""), "progress": "{done} of {trials} done",
           "break": "Block {block} of {blocks} is done. Take a break of {seconds} s or longer; continue when you are ready.",
           "end": "That was the last one. Thank you!"}
FILLED_IN = {"progress": ("done", "trials"), "break": ("block", "blocks", "seconds")}
# The end of a sentence: a stop before a blank, a stop of Chinese and Japanese, a danda of Indic scripts.
SENTENCE_END = re.compile("[.!?\u061f\u06d4\u2026](?= )|[\u3002\uff01\uff1f]|[\u0964\u0965]")


def one_line(text):
    """The text with one blank for each stretch of blanks and line ends of XML; other characters, also other blanks, stay as they are."""
    return re.sub("[ \t\r\n]+", " ", text).strip(" ")


def wrong(text, longest):
    """Why a screen cannot show this text, in one clause; None: it can."""
    if not text or len(text) > longest:
        return f"has {len(text)} characters; write 1 to {longest}"
    for character in text:
        kind = unicodedata.category(character)
        if kind in ("Cc", "Cs", "Zl", "Zp"):
            return f"contains U+{ord(character):04X}, which no line can show; remove it"
    if all(unicodedata.category(character) in ("Zs", "Cf") for character in text):
        return "contains no visible character; write 1 or more"
    return None


def place_to_divide(text):
    """Number of characters, 1 to LONGEST_SCREEN, of the first screen of a longer text: to the end of the last sentence if that fills half of the screen, else to
    the last blank, else as many as fit without a cut between a letter and its marks."""
    screen = text[:LONGEST_SCREEN + 1]  # the blank after a full screen belongs to it
    sentences = [found.end() for found in SENTENCE_END.finditer(screen) if found.end() <= LONGEST_SCREEN]
    if sentences and sentences[-1] >= LONGEST_SCREEN // 2:
        return sentences[-1]
    if (blank := screen.rfind(" ")) > 0:
        return blank
    joined = lambda at: unicodedata.category(text[at])[0] == "M" or "\u200d" in text[at - 1:at + 1]
    return next((at for at in range(LONGEST_SCREEN, LONGEST_SCREEN // 2, -1) if not joined(at)), LONGEST_SCREEN)


def screens(text):
    """The text in parts of at most LONGEST_SCREEN characters, which are shown one after the other."""
    parts = []
    while len(text) > LONGEST_SCREEN:
        at = place_to_divide(text)
        parts.append(text[:at].rstrip(" "))
        text = text[at:].lstrip(" ")
    return [*parts, text] if text or not parts else parts


def fill(phrase, **values):
    """A phrase with its words in braces replaced."""
    for name, value in values.items():
        phrase = phrase.replace("{" + name + "}", str(value))
    return phrase


def participant_name(text):
    """The name of a participant, composed (NFC, Unicode Standard Annex 15): the same letters are one name, however they were typed. Raises Refusal."""
    if any(unicodedata.category(c) == "Cs" for c in text):
        raise Refusal(f"--participant {text}: is not UTF-8; type the name in a terminal that uses UTF-8")
    name = unicodedata.normalize("NFC", text)
    # Letters, marks and digits of any script; a joiner belongs to the spelling of Persian and Indic words.
    kinds = [unicodedata.category(c)[0] for c in name]
    good = all(kind in "LMN" or c in "-_\u200c\u200d" for c, kind in zip(name, kinds)) and any(kind in "LN" for kind in kinds)
    if not good or kinds[0] == "M" or len(name) > LONGEST_CHOICE:
        raise Refusal(f"--participant {text}: give a name of letters, digits, - and _, for example P01, of at most {LONGEST_CHOICE} characters")
    return name
