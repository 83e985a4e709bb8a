#include "sim_node/scene/sdf/sdf_files.h"

#include <tinyxml2.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace tactus::sim {
namespace {

namespace fs = std::filesystem;

// More than any scene has; bounds chains of files that include each other several times.
constexpr int kMaxIncludes = 10'000;

std::string after_scheme(const std::string& uri) {
  const auto at = uri.find("://");
  return at == std::string::npos ? uri : uri.substr(at + 3);
}

bool is_remote(const std::string& uri) { return uri.starts_with("http://") || uri.starts_with("https://"); }
bool is_builtin(const std::string& uri) { return uri == "model://sun" || uri == "model://ground_plane"; }

std::string trimmed(std::string text) {
  const auto blank = [](unsigned char c) { return std::isspace(c) != 0; };
  text.erase(std::find_if_not(text.rbegin(), text.rend(), blank).base(), text.end());
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
  return text;
}

// The SDF file that model.config of a model folder names: the newest version that libsdformat 12 reads.
fs::path file_of_folder(const fs::path& folder) {
  tinyxml2::XMLDocument config;
  if (config.LoadFile((folder / "model.config").c_str()) != tinyxml2::XML_SUCCESS) return {};
  const tinyxml2::XMLElement* model = config.FirstChildElement("model");
  fs::path found;
  double newest = -1;
  for (const auto* sdf = model ? model->FirstChildElement("sdf") : nullptr; sdf; sdf = sdf->NextSiblingElement("sdf")) {
    const double version = sdf->DoubleAttribute("version");
    if (!sdf->GetText() || version > 1.91 || version <= newest) continue;
    newest = version;
    found = folder / trimmed(sdf->GetText());
  }
  return found;
}

}  // namespace

SdfFiles::~SdfFiles() = default;

SdfFiles::SdfFiles(const fs::path& file, std::vector<std::string>& warnings)
    : warnings_(warnings), shown_folder_(file.parent_path()) {
  std::error_code error;
  main_ = fs::weakly_canonical(file, error);
  std::ifstream in(main_, std::ios::binary);
  if (fs::is_directory(main_, error) || !in)
    throw std::runtime_error("scene \"" + file.string() + "\" cannot be read: give the path of an SDF file");
  text_.assign(std::istreambuf_iterator<char>(in), {});
  scan(main_, "", {});
}

std::string SdfFiles::where(const std::string& file, int line) const {
  fs::path display_path = file;
  const fs::path inside = display_path.lexically_relative(main_.parent_path());
  if (!inside.empty()) display_path = shown_folder_ / inside;
  return display_path.string() + (line > 0 ? ":" + std::to_string(line) : "");
}

void SdfFiles::check_version(const tinyxml2::XMLElement& root, const std::string& here) {
  const std::string version = root.Attribute("version") ? root.Attribute("version") : "";
  if (version.empty()) throw std::runtime_error(here + ": <sdf> lacks its version, e.g. version=\"1.9\"");
  const bool major = version.starts_with("1.") && version.size() > 2;
  if (!major || !std::all_of(version.begin() + 2, version.end(), [](unsigned char c) { return std::isdigit(c) != 0; }))
    throw std::runtime_error(here + ": <sdf version=\"" + version + "\"> is not a supported version of SDF: use 1.4 to 1.9");
  if (version.size() > 3)
    warnings_.push_back(here + ": <sdf version=\"" + version + "\"> is newer than 1.9: its new elements are not supported");
}

void SdfFiles::scan(const fs::path& file, const std::string& from, std::vector<fs::path> chain) {
  const std::string included_by = from.empty() ? "" : ", included by " + from;
  if (std::find(chain.begin(), chain.end(), file) != chain.end())
    throw std::runtime_error(from + ": includes \"" + file.filename().string() +
                             "\", which includes this file again: remove the circular include");
  if (documents_.contains(file)) return;
  auto& document = documents_[file] = std::make_unique<tinyxml2::XMLDocument>();
  if (document->LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS)
    throw std::runtime_error(where(file, document->ErrorLineNum()) + ": this is not well-formed XML" + included_by + ": " +
                             document->ErrorStr());
  const tinyxml2::XMLElement* root = document->RootElement();
  if (!root || std::string(root->Value()) != "sdf")
    throw std::runtime_error(where(file, root ? root->GetLineNum() : 1) +
                             ": the outermost element must be <sdf version=\"1.9\">" + included_by);
  check_version(*root, where(file, root->GetLineNum()));

  for (const fs::path& folder : {file.parent_path(), file.parent_path() / "models", file.parent_path().parent_path()})
    if (fs::is_directory(folder) && std::find(folders_.begin(), folders_.end(), folder) == folders_.end())
      folders_.push_back(folder);
  chain.push_back(file);
  // Depth-first without recursion: the document's depth limit bounds the XML, the chain bounds the files.
  std::vector<const tinyxml2::XMLElement*> pending{root};
  while (!pending.empty()) {
    const tinyxml2::XMLElement* element = pending.back();
    pending.pop_back();
    const std::string name = element->Value();
    if (name == "include" && element != root) {
      follow(*element, file, chain);
      continue;
    }
    if (name != "sdf" && name != "world" && name != "model") continue;
    for (auto* child = element->LastChildElement(); child; child = child->PreviousSiblingElement())
      pending.push_back(child);
  }
  if (chain.size() > 1) included_.push_back(file);
}

void SdfFiles::follow(const tinyxml2::XMLElement& include, const fs::path& file, const std::vector<fs::path>& chain) {
  const std::string here = where(file, include.GetLineNum());
  const tinyxml2::XMLElement* uri_element = include.FirstChildElement("uri");
  const std::string uri = uri_element && uri_element->GetText() ? trimmed(uri_element->GetText()) : "";
  if (uri.empty()) throw std::runtime_error(here + ": <include> lacks its <uri>");
  if (++includes_ > kMaxIncludes)
    throw std::runtime_error(here + ": more than " + std::to_string(kMaxIncludes) + " includes: simplify the scene");

  fs::path found = find(uri, file);
  if (found.empty() && (is_remote(uri) || is_builtin(uri))) {
    skipped_.push_back({uri, include.GetLineNum()});
    warnings_.push_back(here + (is_remote(uri) ? ": include of \"" + uri + "\" is skipped: nothing is downloaded, put a "
                                                 "copy beside the file"
                                               : ": include of \"" + uri + "\" is not beside the file: the built-in model replaces it"));
    return;
  }
  if (!found.empty() && fs::is_directory(found)) found = file_of_folder(found);
  if (found.empty() || !fs::is_regular_file(found))
    throw std::runtime_error(here + ": include of \"" + uri + "\" is not found: put it beside the file");
  scan(fs::weakly_canonical(found), here, chain);

  // libsdformat uses the first match in its list of folders, for every including file.
  for (const fs::path& folder : folders_) {
    fs::path first = folder / after_scheme(uri);
    if (!fs::exists(first)) continue;
    if (fs::is_directory(first)) first = file_of_folder(first);
    if (fs::weakly_canonical(first) != fs::weakly_canonical(found))
      throw std::runtime_error(here + ": \"" + uri + "\" exists twice, rename one: " + first.string() + " and " +
                               found.string());
    break;
  }
}

fs::path SdfFiles::find(const std::string& uri, const fs::path& from_file) const {
  if (is_remote(uri)) return {};
  const fs::path rest = after_scheme(uri);
  std::error_code error;
  if (rest.is_absolute()) return fs::exists(rest, error) ? rest : fs::path{};
  for (const fs::path& base : {from_file.parent_path(), main_.parent_path()})
    for (const fs::path& folder : {base, base / "models", base.parent_path()})
      if (fs::exists(folder / rest, error)) return folder / rest;
  return {};
}

const tinyxml2::XMLElement* SdfFiles::in_file(const sdf::Element& element) const {
  const auto document = documents_.find(element.FilePath());
  if (document == documents_.end()) return nullptr;
  const tinyxml2::XMLElement* root = document->second->RootElement();
  if (!element.GetParent()) return root;
  if (element.LineNumber()) {
    // The first element of that name on that line.
    std::vector<const tinyxml2::XMLElement*> pending{root};
    while (!pending.empty()) {
      const tinyxml2::XMLElement* candidate = pending.back();
      pending.pop_back();
      if (candidate->GetLineNum() == *element.LineNumber() && element.GetName() == candidate->Value()) return candidate;
      for (auto* child = candidate->LastChildElement(); child; child = child->PreviousSiblingElement())
        pending.push_back(child);
    }
    return nullptr;
  }
  const tinyxml2::XMLElement* parent = in_file(*element.GetParent());
  if (!parent) return nullptr;
  const tinyxml2::XMLElement* child = parent->FirstChildElement(element.GetName().c_str());
  for (auto sibling = element.GetParent()->GetFirstElement(); sibling && child; sibling = sibling->GetNextElement()) {
    if (sibling.get() == &element) return child;
    if (sibling->GetName() == element.GetName()) child = child->NextSiblingElement(element.GetName().c_str());
  }
  return child;
}

std::string SdfFiles::where(const sdf::Element& element) const {
  if (element.LineNumber()) return where(element.FilePath(), *element.LineNumber());
  if (const tinyxml2::XMLElement* xml = in_file(element)) return where(element.FilePath(), xml->GetLineNum());
  for (auto parent = element.GetParent(); parent; parent = parent->GetParent())
    if (parent->LineNumber()) return where(parent->FilePath(), *parent->LineNumber());
  return where(element.FilePath(), 0);
}

}  // namespace tactus::sim
