"""XML files of the user: studies, tasks, experiments and clusters. Reads one without entities, network access or large amounts of memory."""
from tactus import own_files
from tactus.refusal import Refusal
from tactus.tables import decoded

LARGEST_BYTES = 1_000_000
ENCODINGS = ("UTF-8", "US-ASCII", "ASCII")  # of the declaration of a file; ASCII is a part of UTF-8


def quoted(text):
    """`text` as the value of an attribute, with its quotes."""
    from xml.sax.saxutils import quoteattr  # loads slowly
    return quoteattr(text)


def root_of(path, text, kind, shipped=(), largest_bytes=LARGEST_BYTES, keeps_comments=False):
    """(root element, bytes) of the file at `path`. text: the file as the user named it, for messages; kind: "a study file", for example; shipped: names of
    the shipped files of this kind; keeps_comments: for a file that is written again. Raises Refusal with the line."""
    shipped = ", ".join(shipped)
    try:
        data = own_files.read_regular(path, largest_bytes)
    except OSError as error:
        raise Refusal(f"{text}: cannot be read ({error.strerror}); give {kind}" + (f", or one of {shipped}" if shipped else "")) from None
    if len(data) > largest_bytes:
        raise Refusal(f"{text}: is longer than {largest_bytes} bytes; give {kind}")
    decoded(data, text)
    from lxml import etree  # loads slowly
    try:
        root = etree.fromstring(data, etree.XMLParser(resolve_entities=False, no_network=True, remove_comments=not keeps_comments, remove_pis=not keeps_comments))
    except etree.XMLSyntaxError as error:
        raise Refusal(f"{text}:{error.lineno}: {error.msg.splitlines()[0]}") from None
    except ValueError as error:
        raise Refusal(f"{text}:1: {str(error).splitlines()[0]}") from None
    if root.getroottree().docinfo.internalDTD is not None:
        raise Refusal(f"{text}:1: has a <!DOCTYPE>, but {kind} uses no entities and no defaults; remove it and write its entities out")
    encoding = root.getroottree().docinfo.encoding
    if encoding and encoding.upper() not in ENCODINGS:
        raise Refusal(f"{text}:1: declares the encoding {encoding}; save the file as UTF-8, and declare that")
    return root, data
