// Why a text is not XML, in words of the user instead of codes of tinyxml2. Thread-safe: yes.
#pragma once

#include <string>

namespace tinyxml2 {
class XMLDocument;
}

namespace tactus::sync {

// Of a document that could not be parsed: a clause with the remedy, "an element is closed by another name than its own, or not at all; ...".
std::string xml_reason(const tinyxml2::XMLDocument& document);

}  // namespace tactus::sync
