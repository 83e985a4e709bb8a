# Patches a generated decoder so that it rejects invalid lengths before an allocation: lcm-gen 1.3.1 resizes to any count in
# the message, and builds a string of length - 1 from a length of 0. Each element has at least one byte on the wire, so a count
# above the remaining bytes is invalid.
file(READ ${HEADER} text)
string(REGEX REPLACE
  "this->([A-Za-z0-9_]+)\\.resize\\(this->([A-Za-z0-9_]+)\\);"
  "if (this->\\2 < 0 || this->\\2 > maxlen - pos) return -1;\n    this->\\1.resize(this->\\2);" text "${text}")
string(REGEX REPLACE "if\\((__[a-z0-9_]+_len__|__elem_len) > maxlen - pos\\)"
  "if(\\1 < 1 || \\1 > maxlen - pos)" text "${text}")
file(WRITE ${HEADER} "${text}")
