#include "sync/text/xml_reason.h"

#include <tinyxml2.h>

namespace tactus::sync {

std::string xml_reason(const tinyxml2::XMLDocument& document) {
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT: return "it is empty; write its elements";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT: return "an element is closed by another name than its own, or not at all; close it by its name";
    case tinyxml2::XML_ERROR_PARSING_ELEMENT: return "a tag is incomplete; end it with > or />";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE: return "an attribute is not NAME=\"VALUE\"; write its value in quotes, and each name once";
    case tinyxml2::XML_ERROR_PARSING_TEXT: return "a text stands outside of an element, or its element is not closed; write elements in < and >";
    case tinyxml2::XML_ERROR_PARSING_CDATA: return "a CDATA section does not end; end it with ]]>";
    case tinyxml2::XML_ERROR_PARSING_COMMENT: return "a comment does not end; end it with -->";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION: return "the declaration <?xml ...?> is incomplete, or not at the beginning; move or remove it";
    case tinyxml2::XML_ERROR_PARSING_UNKNOWN: return "a <! ... > does not end; end it with >";
    case tinyxml2::XML_ERROR_PARSING: return "it ends before its last element is closed; close the element, or copy the whole file again";
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED: return "its elements are nested too deeply; simplify it";
    default: return "it cannot be parsed; write elements in < and >";
  }
}

}  // namespace tactus::sync
