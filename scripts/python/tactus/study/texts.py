"""Texts that a study shows to its participant, in any language: their characters, their length, and their size in a message."""
import re
import unicodedata

from tactus.refusal import Refusal

LONGEST_TEXT, LONGEST_CHOICE, LONGEST_LINE = 600, 40, 64  # characters: lcmtypes/types/control/question_t.lcm
# A question and its choices are one message of at most 1400 bytes (lcmtypes/channels.h, kMaxMessageBytes). Besides its texts it has its fingerprint (8 bytes), the header
# (48), id, kind, count, three numbers and the trial (41); each text has a length of 4 bytes and a final zero. Name of the condition and progress have 64 bytes each.
MESSAGE_BYTES, OTHER_BYTES, TEXT_BYTES = 1400, 8 + 48 + 41, 5
SPOKEN = {"haptic": "touch", "audio": "sound", "visual": "picture", "thermal": "warmth"}
# Texts that the session shows by itself; <phrase of=""> of a study file replaces them. The words in braces are filled in.
PHRASES = {**SPOKEN, "progress": "{done} of {trials} done",
           "break": "Block {block} of {blocks} is done. Take a break of {seconds} s or longer; continue when you are ready.",
           "end": "That was the last one. Thank you!"}
FILLED_IN = {"progress": ("done", "trials"), "break": ("block", "blocks", "seconds")}


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


def message_bytes(text, choices=()):
    """The largest size of the message that asks this, in bytes."""
    return OTHER_BYTES + 2 * (LONGEST_LINE + TEXT_BYTES) + sum(len(part.encode()) + TEXT_BYTES for part in (text, *choices))


def too_large(text, choices=()):
    """Why one message cannot hold a text with its choices, in one clause; None: it can."""
    over = message_bytes(text, choices) - MESSAGE_BYTES
    if over <= 0:
        return None
    found = sum(len(part.encode()) for part in (text, *choices))
    return f"{'with its choices has' if choices else 'has'} {found} bytes in UTF-8, and one screen holds {found - over}; shorten it, or divide it into several"


def fill(phrase, **values):
    """A phrase with its words in braces replaced."""
    for name, value in values.items():
        phrase = phrase.replace("{" + name + "}", str(value))
    return phrase


def first_bytes(text, most):
    """The longest beginning of at most this number of bytes in UTF-8 that ends between two characters."""
    return text.encode()[:most].decode("utf-8", "ignore")


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
