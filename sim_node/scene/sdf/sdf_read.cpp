#include "sim_node/scene/sdf/sdf_read.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <sdf/Console.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/SDFImpl.hh>
#include <sdf/parser.hh>
#include <sstream>
#include <stdexcept>

namespace tactus::sim {
namespace {

// While an instance exists, libsdformat writes nothing to the terminal or to a log file in the home folder.
class MutedConsole {
 public:
  MutedConsole() : console_(std::cerr.rdbuf(captured_.rdbuf())) {
    static const bool made = [] {
      const char* home = std::getenv("HOME");
      const std::string before = home ? home : "";
      setenv("HOME", "/dev/null", 1);  // the console opens $HOME/.sdformat/sdformat.log when it is created
      sdf::Console::Instance();
      home ? setenv("HOME", before.c_str(), 1) : unsetenv("HOME");
      return true;
    }();
    (void)made;
  }
  // The first printed error, without colours and source line: "Error [Param.cc:1] message" in escape sequences.
  // libsdformat prints more than it returns, for example the value that it could not read.
  std::string first_error() const {
    std::istringstream lines(captured_.str());
    for (std::string line; std::getline(lines, line);) {
      std::string plain;
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '\033') i = std::min(line.find('m', i), line.size() - 1);
        else plain += line[i];
      }
      const auto end = plain.find("] ");
      if (plain.starts_with("Error [") && end != std::string::npos) return plain.substr(end + 2);
    }
    return "";
  }
  ~MutedConsole() { std::cerr.rdbuf(console_); }
  MutedConsole(const MutedConsole&) = delete;
  MutedConsole& operator=(const MutedConsole&) = delete;

 private:
  std::ostringstream captured_;
  std::streambuf* console_;
};

void configure(const SdfFiles& files) {
  sdf::ParserConfig config;
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);  // unsupported.h reports these with a line
  config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
  config.SetFindCallback([](const std::string&) { return std::string(); });
  for (const auto& folder : files.folders())
    for (const char* scheme : {"", "model://", "file://"}) config.AddURIPath(scheme, folder.string());
  sdf::ParserConfig::GlobalConfig() = config;  // included files are read with this one only
}

bool tolerated(const sdf::Error& error, const SdfFiles& files) {
  // bodies.h checks the inertia itself and names the line.
  if (error.Code() == sdf::ErrorCode::LINK_INERTIA_INVALID) return true;
  if (error.Code() == sdf::ErrorCode::URI_LOOKUP)
    for (const auto& skipped : files.skipped())
      if (error.Message().find("[" + skipped.uri + "]") != std::string::npos) return true;
  return error.Message().starts_with("Failed to load a world");
}

// The element that an error without a line refers to: the first one whose name the message quotes.
const sdf::Element* find_quoted_element(const sdf::ElementPtr& element, const std::string& message) {
  if (!element) return nullptr;
  for (auto child = element->GetFirstElement(); child; child = child->GetNextElement())
    if (const sdf::Element* found = find_quoted_element(child, message)) return found;
  if (!element->HasAttribute("name") || !element->LineNumber()) return nullptr;
  const std::string name = element->GetAttribute("name")->GetAsString();
  for (const auto& [open, close] : {std::pair{"[", "]"}, {"'", "'"}, {"named ", " "}})
    if (message.find(open + name + close) != std::string::npos) return element.get();
  return nullptr;
}

void throw_first_error(const sdf::Errors& errors, const sdf::ElementPtr& root, const SdfFiles& files,
                       const MutedConsole& muted) {
  const sdf::Error* first = nullptr;
  int more = 0;
  for (const sdf::Error& error : errors) {
    if (tolerated(error, files)) continue;
    first ? void(++more) : void(first = &error);
  }
  if (!first) return;
  std::string message = first->Message();
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) message.pop_back();
  std::string where = files.where(first->FilePath().value_or(files.main_file().string()), first->LineNumber().value_or(0));
  if (!first->LineNumber())
    if (const sdf::Element* element = find_quoted_element(root, message)) where = files.where(*element);
  const std::string printed = message.starts_with("Error reading element") ? muted.first_error() : "";
  if (!printed.empty()) message += ": " + printed;
  throw std::runtime_error(where + ": " + message + (more ? " (and " + std::to_string(more) + " more)" : ""));
}

}  // namespace

std::unique_ptr<sdf::Root> read_sdf(const SdfFiles& files) {
  const MutedConsole muted;
  configure(files);
  auto root = std::make_unique<sdf::Root>();
  try {
    for (const auto& file : files.included()) {
      sdf::Errors errors;
      sdf::readFile(file.string(), sdf::ParserConfig::GlobalConfig(), errors);
      throw_first_error(errors, nullptr, files, muted);
    }
    const sdf::Errors errors = root->Load(files.main_file().string(), sdf::ParserConfig::GlobalConfig());
    throw_first_error(errors, root->Element(), files, muted);
  } catch (const std::runtime_error&) {
    throw;
  } catch (const std::exception& e) {
    throw std::runtime_error(files.where(files.main_file().string(), 0) + ": libsdformat failed: " + e.what());
  }
  return root;
}

}  // namespace tactus::sim
