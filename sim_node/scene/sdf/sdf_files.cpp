#include "sim_node/scene/sdf/sdf_files.h"

#include <tinyxml2.h>

#include <algorithm>
#include <stdexcept>

#include "sim_node/scene/sdf/model_folder.h"
#include "sim_node/scene/sdf/xml_scan.h"
#include "sync/sandbox/regular_file.h"
#include "sync/text/xml_reason.h"

namespace tactus::sim {
namespace {

namespace fs = std::filesystem;

// More than any scene has (design).
constexpr int kMaxIncludes = 100'000;
constexpr std::size_t kMaxChain = 32;  // files that include each other one below the other
constexpr std::uintmax_t kMaxFileBytes = 16 << 20, kMaxTotalBytes = 64 << 20;
// Elements, with their ends, attributes and comments. Each takes tinyxml2 about 120 bytes, and a text between two of them as
// much: these are 600 MB at most.
constexpr std::size_t kMaxParts = 2'500'000;
constexpr std::size_t kMaxAttributes = 256;  // of an element: they are found by a search (design)

std::string after_scheme(const std::string& uri) {
  const auto at = uri.find("://");
  return at == std::string::npos ? uri : uri.substr(at + 3);
}

bool is_remote(const std::string& uri) { return uri.starts_with("http://") || uri.starts_with("https://"); }
bool is_builtin(const std::string& uri) { return uri == "model://sun" || uri == "model://ground_plane"; }

std::string root_sentence(const tinyxml2::XMLElement* root) {
  const std::string name = root ? root->Value() : "";
  if (name == "robot")
    return "this is a robot in URDF, and the outermost element must be <sdf version=\"1.9\">: convert it with "
           "gz sdf -p ROBOT.urdf > robot.sdf";
  return "the outermost element must be <sdf version=\"1.9\">";
}

}  // namespace

SdfFiles::~SdfFiles() = default;

SdfFiles::SdfFiles(const fs::path& file, std::vector<std::string>& warnings, const std::vector<fs::path>& folders)
    : warnings_(warnings), shown_folder_(file.parent_path()), named_(folders), readable_({}) {
  std::error_code error;
  main_ = fs::weakly_canonical(file, error);
  try {
    text_ = sync::read_regular_text(main_, kMaxFileBytes);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error("scene \"" + file.string() + "\" cannot be read (" + e.what() +
                             "): give the path of an SDF file");
  }
  std::vector<fs::path> readable{main_.parent_path()};
  readable.insert(readable.end(), folders.begin(), folders.end());
  readable_ = sync::ReadableFolders(readable);
  named_.assign(readable_.folders().begin() + 1, readable_.folders().end());
  std::vector<fs::path> chain;
  scan(main_, "", chain);
}

const SdfFiles::Document& SdfFiles::main() const { return documents_.at(main_.string()); }

const SdfFiles::Document* SdfFiles::included_by(const tinyxml2::XMLElement& include) const {
  const auto found = included_.find(&include);
  return found == included_.end() ? nullptr : found->second;
}

std::string SdfFiles::shown(const fs::path& file) const {
  const fs::path inside = file.lexically_relative(main_.parent_path());
  return (inside.empty() ? file : shown_folder_ / inside).string();
}

void SdfFiles::check_version(sdf::Source& source, const tinyxml2::XMLElement& root) {
  const std::string here = sdf::where(source, root.GetLineNum());
  const std::string version(sdf::trimmed(root.Attribute("version") ? root.Attribute("version") : ""));
  if (version.empty()) throw std::runtime_error(here + ": <sdf> lacks its version, e.g. version=\"1.9\"");
  const auto minor = sdf::minor_version(version);
  if (!minor)
    throw std::runtime_error(here + ": <sdf version=\"" + version + "\"> is not a supported version of SDF: use 1.4 to 1.12");
  if (*minor < sdf::kOldestVersion)
    throw std::runtime_error(here + ": <sdf version=\"" + version +
                             "\"> is older than 1.4, the oldest version that is read: convert it with gz sdf -p OLD.sdf > new.sdf");
  if (*minor > sdf::kNewestVersion)
    sdf::add_warning(warnings_, here + ": <sdf version=\"" + version + "\"> is newer than 1.12: its new elements are not supported");
  source.version = *minor;
}

void SdfFiles::parse(Document& document, const std::string& included_by) {
  const fs::path& file = document.source.file;
  std::string text;
  try {
    text = file == main_ ? text_ : sync::read_regular_text(file, kMaxFileBytes);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(document.source.shown + ": this cannot be read" + included_by + ": " + e.what());
  }
  if ((bytes_ += text.size()) > kMaxTotalBytes)
    throw std::runtime_error(document.source.shown + ": the files of the scene are larger than " +
                             std::to_string(kMaxTotalBytes >> 20) + " MiB together: simplify the scene");
  const sdf::XmlCount parts = sdf::count_xml(text);
  if (parts.max_attributes > kMaxAttributes)
    throw std::runtime_error(sdf::where(document.source, parts.line) + ": an element has more than " +
                             std::to_string(kMaxAttributes) + " attributes: remove some");
  if ((parts_ += parts.parts) > kMaxParts)
    throw std::runtime_error(document.source.shown + ": the files of the scene have more than " +
                             std::to_string(kMaxParts) + " elements, attributes and comments: simplify the scene");
  if (const std::string_view encoding = sdf::other_encoding(text); !encoding.empty())
    throw std::runtime_error(sdf::where(document.source, 1) + ": this is " + std::string(encoding) + " and not UTF-8" + included_by +
                             ": save it as UTF-8");
  tinyxml2::XMLDocument& xml = *document.xml;
  if (xml.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw std::runtime_error(sdf::where(document.source, xml.ErrorLineNum()) + ": this is not well-formed XML" +
                             included_by + ": " + sync::xml_reason(xml));
  for (const tinyxml2::XMLNode* node = xml.FirstChild(); node; node = node->NextSibling())
    if (node->ToUnknown())
      sdf::add_warning(warnings_, sdf::where(document.source, node->GetLineNum()) +
                                      ": <!DOCTYPE> has no effect: its entities are not replaced, write them out");
  const tinyxml2::XMLElement* root = xml.RootElement();
  if (!root || std::string(root->Value()) != "sdf")
    throw std::runtime_error(sdf::where(document.source, root ? root->GetLineNum() : 1) + ": " + root_sentence(root) +
                             included_by);
  check_version(document.source, *root);
}

const SdfFiles::Document& SdfFiles::scan(const fs::path& file, const std::string& from, std::vector<fs::path>& chain) {
  if (std::find(chain.begin(), chain.end(), file) != chain.end())
    throw std::runtime_error(from + ": includes \"" + file.filename().string() +
                             "\", which includes this file again: remove the circular include");
  const auto [at, is_new] = documents_.try_emplace(file.string());
  Document& document = at->second;  // stays where it is when the map grows
  if (!is_new) return document;
  if (chain.size() == kMaxChain)
    throw std::runtime_error(from + ": more than " + std::to_string(kMaxChain) +
                             " files include each other one below the other: simplify the scene");
  document.source = {file, shown(file), 0};
  document.xml = std::make_unique<tinyxml2::XMLDocument>();
  parse(document, from.empty() ? "" : ", included by " + from);
  chain.push_back(file);
  // Depth-first without recursion: the document's depth limit bounds the XML, the chain bounds the files.
  struct Pending {
    const tinyxml2::XMLElement* element;
    int depth;
    bool foreign;
  };
  std::vector<Pending> pending{{document.xml->RootElement(), 1, false}};
  while (!pending.empty()) {
    const auto [element, depth, foreign] = pending.back();
    pending.pop_back();
    const std::string_view name = element->Value();
    count(document, element->GetLineNum(), {1, 0, depth});
    if (name == "include" && !foreign && element != document.xml->RootElement()) follow(*element, document, depth, chain);
    // A comment counts as an element, because each include of the file passes over it. A text does not: two of them have
    // something between them.
    for (const tinyxml2::XMLNode* child = element->LastChild(); child; child = child->PreviousSibling())
      if (const tinyxml2::XMLElement* inner = child->ToElement())
        pending.push_back({inner, depth + 1, foreign || sdf::is_foreign(name)});
      else if (!child->ToText())
        count(document, child->GetLineNum(), {1, 0, depth});
  }
  chain.pop_back();
  return document;
}

// Each file counts with everything that it includes, because an included file is copied for every include. A file is
// complete before the file that includes it, so the sum needs no second pass.
void SdfFiles::count(Document& document, int line, const Size& more) const {
  document.elements += more.elements;
  document.copies += more.copies;
  document.depth = std::max(document.depth, more.depth);
  const auto here = [&] { return sdf::where(document.source, line); };
  if (document.copies > kMaxCopiedElements)
    throw std::runtime_error(here() + ": the copies of included files have more than " +
                             std::to_string(kMaxCopiedElements) + " elements: include them less often");
  if (document.elements > kMaxSceneElements)
    throw std::runtime_error(here() + ": the scene has more than " + std::to_string(kMaxSceneElements) +
                             " elements: simplify it");
  if (document.depth > kMaxSceneDepth)
    throw std::runtime_error(here() + ": the elements are nested deeper than " + std::to_string(kMaxSceneDepth) +
                             " levels with their includes: simplify the scene");
}

void SdfFiles::follow(const tinyxml2::XMLElement& include, Document& document, int depth, std::vector<fs::path>& chain) {
  const std::string here = sdf::where(document.source, include.GetLineNum());
  const std::string parent = include.Parent()->ToElement()->Value();
  if (parent != "sdf" && parent != "world" && parent != "model")
    throw std::runtime_error(here + ": <include> is inside <" + parent + ">: move it into <world> or <model>");
  const tinyxml2::XMLElement* uri_element = include.FirstChildElement("uri");
  const std::string uri(sdf::trimmed(uri_element && uri_element->GetText() ? uri_element->GetText() : ""));
  if (uri.empty()) throw std::runtime_error(here + ": <include> lacks its <uri>");
  if (++includes_ > kMaxIncludes)
    throw std::runtime_error(here + ": more than " + std::to_string(kMaxIncludes) + " includes: simplify the scene");
  const std::size_t known = documents_.size();
  const Document* included = document_of(include, uri, document, chain);
  if (!included) return;
  included_[&include] = included;
  const bool again = documents_.size() == known;
  count(document, include.GetLineNum(),
        {included->elements, again ? included->elements : included->copies, depth + included->depth});
}

const SdfFiles::Document* SdfFiles::document_of(const tinyxml2::XMLElement& include, const std::string& uri,
                                                const Document& from, std::vector<fs::path>& chain) {
  const std::string here = sdf::where(from.source, include.GetLineNum());
  fs::path found = find(uri, from.source.file);
  if (found.empty() && (is_remote(uri) || is_builtin(uri))) {
    skipped_.push_back({uri, include.GetLineNum()});
    sdf::add_warning(warnings_, here + ": include of \"" + uri + "\" is " +
                        (is_remote(uri) ? "skipped: nothing is downloaded, put a copy beside the file"
                                        : "not beside the file: the built-in model replaces it"));
    return nullptr;
  }
  std::error_code error;
  if (!found.empty() && fs::is_directory(found, error)) {
    if (!readable_.resolve(found)) throw std::runtime_error(here + ": include of \"" + uri + "\" " + kOutside);
    const auto [at, is_new] = file_of_folder_.try_emplace(found.string());
    if (is_new) at->second = sdf::file_of_model_folder(found);
    found = at->second;
  }
  if (found.empty() || !fs::is_regular_file(found, error))
    throw std::runtime_error(here + ": include of \"" + uri + "\" is not found: put it beside the file");
  const auto readable = readable_.resolve(found);
  if (!readable) throw std::runtime_error(here + ": include of \"" + uri + "\" " + kOutside);
  return &scan(*readable, here, chain);
}

fs::path SdfFiles::find(const std::string& uri, const fs::path& from_file) const {
  if (is_remote(uri)) return {};
  const fs::path rest = after_scheme(uri);
  std::error_code error;
  if (rest.is_absolute()) return fs::exists(rest, error) ? rest : fs::path{};
  for (const fs::path& base : {from_file.parent_path(), main_.parent_path()})
    for (const fs::path& folder : {base, base / "models", base.parent_path()})
      if (fs::exists(folder / rest, error)) return folder / rest;
  for (const fs::path& folder : named_)
    if (fs::exists(folder / rest, error)) return folder / rest;
  return {};
}

}  // namespace tactus::sim
