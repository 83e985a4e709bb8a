#include "sim_node/scene/sdf/sdf_files.h"

#include <tinyxml2.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sync/sandbox/regular_file.h"

namespace tactus::sim {
namespace {

namespace fs = std::filesystem;

// More than any scene has (design). They bound files that include each other several times: ten files of 500 bytes that
// each include the next one ten times have 10^10 models.
constexpr int kMaxIncludes = 10'000;
constexpr std::size_t kMaxChain = 32;  // files that include each other one below the other
// Memory that libsdformat 12 takes for an element with its defaults, measured with 100 to 500 of each; kB. Its 20 s for
// 3,000 bodies (sim_node/scenes/make_many_bodies.py) are 8 GB.
constexpr std::pair<std::string_view, std::size_t> kElement_kB[] = {
    {"model", 1500}, {"link", 850}, {"joint", 570}, {"sensor", 560}, {"collision", 170}, {"visual", 160}, {"light", 50}};
constexpr std::size_t kOther_kB = 10;
// An include costs libsdformat 33 ms, the time in which it fills this memory with elements that stand in one file.
constexpr std::size_t kInclude_kB = 1000;
constexpr std::size_t kMaxScene_kB = 10'000'000;
constexpr std::size_t kMaxCopies_kB = 2'000'000;  // 570 copies of a body: a small scene needs little memory
// libsdformat's functions call themselves for each level (tinyxml2 has the same limit for one file).
constexpr int kMaxDepth = 100;
constexpr std::uintmax_t kMaxFileBytes = 16 << 20, kMaxTotalBytes = 64 << 20, kMaxConfigBytes = 64 << 10;

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

// libsdformat copies the content of these without reading it.
bool is_copied(const std::string& name) { return name == "plugin" || name.find(':') != std::string::npos; }

std::size_t memory_kB(std::string_view name) {
  for (const auto& [known, kB] : kElement_kB)
    if (name == known) return kB;
  return kOther_kB;
}

// The SDF file that model.config of a model folder names: the newest version that libsdformat 12 reads.
fs::path file_of_folder(const fs::path& folder) {
  tinyxml2::XMLDocument config;
  try {
    const std::string text = sync::read_regular_text(folder / "model.config", kMaxConfigBytes);
    if (config.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) return {};
  } catch (const std::runtime_error&) {
    return {};
  }
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

void SdfFiles::parse(const fs::path& file, const std::string& included_by, tinyxml2::XMLDocument& document) {
  std::string text;
  try {
    text = file == main_ ? text_ : sync::read_regular_text(file, kMaxFileBytes);
  } catch (const std::runtime_error& e) {
    throw std::runtime_error(where(file, 0) + ": this cannot be read" + included_by + ": " + e.what());
  }
  if ((bytes_ += text.size()) > kMaxTotalBytes)
    throw std::runtime_error(where(file, 0) + ": the files of the scene are larger than " +
                             std::to_string(kMaxTotalBytes >> 20) + " MiB together: simplify the scene");
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw std::runtime_error(where(file, document.ErrorLineNum()) + ": this is not well-formed XML" + included_by + ": " +
                             document.ErrorStr());
  const tinyxml2::XMLElement* root = document.RootElement();
  if (!root || std::string(root->Value()) != "sdf")
    throw std::runtime_error(where(file, root ? root->GetLineNum() : 1) +
                             ": the outermost element must be <sdf version=\"1.9\">" + included_by);
  check_version(*root, where(file, root->GetLineNum()));
}

void SdfFiles::add_search_folders(const fs::path& file) {
  std::vector<fs::path> folders{file.parent_path(), file.parent_path() / "models", file.parent_path().parent_path()};
  folders.insert(folders.end(), named_.begin(), named_.end());
  std::error_code error;
  for (const fs::path& folder : folders)
    if (fs::is_directory(folder, error) && std::find(folders_.begin(), folders_.end(), folder) == folders_.end())
      folders_.push_back(folder);
}

void SdfFiles::scan(const fs::path& file, const std::string& from, std::vector<fs::path>& chain) {
  if (std::find(chain.begin(), chain.end(), file) != chain.end())
    throw std::runtime_error(from + ": includes \"" + file.filename().string() +
                             "\", which includes this file again: remove the circular include");
  if (documents_.contains(file)) return;
  if (chain.size() == kMaxChain)
    throw std::runtime_error(from + ": more than " + std::to_string(kMaxChain) +
                             " files include each other one below the other: simplify the scene");
  auto& document = documents_[file] = std::make_unique<tinyxml2::XMLDocument>();
  parse(file, from.empty() ? "" : ", included by " + from, *document);
  add_search_folders(file);
  chain.push_back(file);
  // Depth-first without recursion: the document's depth limit bounds the XML, the chain bounds the files.
  struct Pending {
    const tinyxml2::XMLElement* element;
    int depth;
    bool copied;
  };
  std::vector<Pending> pending{{document->RootElement(), 1, false}};
  while (!pending.empty()) {
    const auto [element, depth, copied] = pending.back();
    pending.pop_back();
    const std::string name = element->Value();
    count(file, *element, {copied || is_copied(name) ? 0 : memory_kB(name), 0, depth});
    if (name == "include" && !copied && element != document->RootElement())
      follow(*element, file, depth, chain);
    for (auto* child = element->LastChildElement(); child; child = child->PreviousSiblingElement())
      pending.push_back({child, depth + 1, copied || is_copied(name)});
  }
  chain.pop_back();
  if (!chain.empty()) included_.push_back(file);
}

// Each file counts with everything that it includes, because libsdformat copies an included file for every include. A file
// is complete before the file that includes it, so the sum needs no second pass.
void SdfFiles::count(const fs::path& file, const tinyxml2::XMLElement& at, const Size& more) {
  Size& size = sizes_[file];
  size.all_kB += more.all_kB;
  size.copies_kB += more.copies_kB;
  size.depth = std::max(size.depth, more.depth);
  if (size.copies_kB > kMaxCopies_kB)
    throw std::runtime_error(where(file, at.GetLineNum()) + ": the copies of included files need more than " +
                             std::to_string(kMaxCopies_kB / 1'000'000) + " GB of memory: include them less often");
  if (size.all_kB > kMaxScene_kB)
    throw std::runtime_error(where(file, at.GetLineNum()) + ": the scene needs more than " +
                             std::to_string(kMaxScene_kB / 1'000'000) + " GB of memory to read: simplify it");
  if (size.depth > kMaxDepth)
    throw std::runtime_error(where(file, at.GetLineNum()) + ": the elements are nested deeper than " +
                             std::to_string(kMaxDepth) + " levels with their includes: simplify the scene");
}

void SdfFiles::follow(const tinyxml2::XMLElement& include, const fs::path& file, int depth, std::vector<fs::path>& chain) {
  const std::string here = where(file, include.GetLineNum());
  const std::string parent = include.Parent()->ToElement()->Value();
  if (parent != "sdf" && parent != "world" && parent != "model")
    throw std::runtime_error(here + ": <include> is inside <" + parent + ">: move it into <world> or <model>");
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
  std::error_code error;
  if (!found.empty() && fs::is_directory(found, error)) found = file_of_folder(found);
  if (found.empty() || !fs::is_regular_file(found, error))
    throw std::runtime_error(here + ": include of \"" + uri + "\" is not found: put it beside the file");
  const auto readable = readable_.resolve(found);
  if (!readable) throw std::runtime_error(here + ": include of \"" + uri + "\" " + kOutside);
  const bool again = documents_.contains(*readable);
  scan(*readable, here, chain);
  const Size size = sizes_[*readable];
  count(file, include, {size.all_kB, again ? size.all_kB + kInclude_kB : size.copies_kB, depth + size.depth});

  // libsdformat uses the first match in its list of folders, for every including file.
  for (const fs::path& folder : folders_) {
    fs::path first = folder / after_scheme(uri);
    if (!fs::exists(first, error)) continue;
    if (fs::is_directory(first, error)) first = file_of_folder(first);
    if (fs::weakly_canonical(first, error) != *readable)
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
  for (const fs::path& folder : named_)
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
