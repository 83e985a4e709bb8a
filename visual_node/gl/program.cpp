#include "visual_node/gl/program.h"

#include <epoxy/gl.h>

#include <array>
#include <cctype>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "visual_node/gl/shader_text.h"

namespace tactus::visual {
namespace {

// Lines of piece i are numbered from i times this, so that a line number identifies the piece: Mesa names the piece
// in some of its messages only.
constexpr std::size_t kLinesOfPiece = 100'000;  // more than the lines of a file of 64 kB

// The line number in a driver's message, and the text behind it.
struct Position {
  std::size_t line, end;
};

// Drivers begin a message with "0:12(5): " (Mesa) or "0(12) : " (NVIDIA) or "ERROR: 0:12: ": piece number and line.
std::optional<Position> position_in(const std::string& message) {
  std::size_t i = message.starts_with("ERROR: ") ? 7 : 0;
  const auto digits = [&] {
    const std::size_t first = i;
    while (i < message.size() && std::isdigit(static_cast<unsigned char>(message[i]))) ++i;
    return message.substr(first, i - first);
  };
  const auto skip = [&](const char* any) { return i < message.size() && std::string_view(any).find(message[i]) != std::string_view::npos && ++i; };
  if (digits().empty() || !skip(":(")) return std::nullopt;
  const std::string number = digits();
  if (number.empty()) return std::nullopt;
  skip(")");
  if (skip("(")) digits(), skip(")");
  while (skip(" \t")) {
  }
  if (!skip(":")) return std::nullopt;
  return Position{std::stoul(number.substr(0, 9)), i};
}

// Each error becomes one clause; after the first few only their count is given, since they usually follow from the
// first. Warnings are left out, since inputs are assigned before use.
constexpr int kMaxClauses = 3;  // design: readable at a glance
std::string with_files(const std::string& log, const std::vector<std::string>& names) {
  std::string text, line;
  int clauses = 0;
  for (std::istringstream lines(log.c_str()); std::getline(lines, line);) {
    if (line.empty() || line.find(": warning") != std::string::npos || ++clauses > kMaxClauses) continue;
    if (const auto found = position_in(line)) {
      const std::size_t piece = found->line / kLinesOfPiece;
      line = (piece < names.size() ? names[piece] : "?") + ":" + std::to_string(found->line % kLinesOfPiece) + ":" +
             line.substr(found->end);
    }
    text += (text.empty() ? "" : "; ") + line;
  }
  if (clauses > kMaxClauses) text += "; and " + std::to_string(clauses - kMaxClauses) + " more";
  return text;
}

// #line keeps the line numbers of the file.
std::string concatenate(const std::vector<ShaderPiece>& pieces, const std::string& defines) {
  std::string text = "#version 330 core\n" + defines;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::string piece = pieces[i].text;
    if (const auto version = piece.find("#version"); version != std::string::npos) piece.replace(version, 2, "//");
    text += "\n#line " + std::to_string(i * kLinesOfPiece + 1) + " " + std::to_string(i) + "\n" + piece + "\n";
  }
  return text;
}

std::vector<std::string> names_of(const std::vector<ShaderPiece>& pieces) {
  std::vector<std::string> names;
  for (const ShaderPiece& p : pieces) names.push_back(p.name);
  return names;
}

// Inserts the defines after the version line; #line keeps the line numbers of the file.
std::string with_defines(std::string_view source, const std::string& defines) {
  const auto first = source.find('\n') + 1;
  return std::string(source.substr(0, first)) + defines + "#line 2\n" + std::string(source.substr(first));
}

class Shader {
 public:
  Shader(unsigned kind, const std::string& name, std::string_view source, const std::string& defines)
      : Shader(kind, source.empty() ? std::string() : with_defines(source, defines), {name}) {}
  Shader(unsigned kind, const std::string& text, const std::vector<std::string>& names) {
    if (text.empty()) throw std::runtime_error("there is no shader " + names.front());
    id_ = glCreateShader(kind);
    const char* pointer = text.c_str();
    glShaderSource(id_, 1, &pointer, nullptr);
    glCompileShader(id_);
    int good = 0, length = 0;
    glGetShaderiv(id_, GL_COMPILE_STATUS, &good);
    if (good) return;
    glGetShaderiv(id_, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(id_, length, nullptr, log.data());
    glDeleteShader(id_);
    throw std::runtime_error("a shader does not compile: " + with_files(log, names));
  }
  ~Shader() { glDeleteShader(id_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  unsigned id() const { return id_; }

 private:
  unsigned id_ = 0;
};

}  // namespace

Program::Program(const std::string& name, const std::string& defines)
    : Program(name + ".vert", shader_text(name + ".vert"), name + ".frag", shader_text(name + ".frag"), defines) {}

Program::Program(const std::string& vertex_name, std::string_view vertex, const std::string& fragment_name,
                 std::string_view fragment, const std::string& defines) {
  const Shader v(GL_VERTEX_SHADER, vertex_name, vertex, defines),
      f(GL_FRAGMENT_SHADER, fragment_name, fragment, defines);
  link(v.id(), f.id(), vertex_name + " and " + fragment_name);
}

Program::Program(const std::vector<ShaderPiece>& vertex, const std::vector<ShaderPiece>& fragment,
                 const std::string& defines) {
  const Shader v(GL_VERTEX_SHADER, concatenate(vertex, defines), names_of(vertex)),
      f(GL_FRAGMENT_SHADER, concatenate(fragment, defines), names_of(fragment));
  link(v.id(), f.id(), names_of(vertex).back() + " and " + names_of(fragment).back());
}

void Program::link(unsigned vertex, unsigned fragment, const std::string& names) {
  id_ = glCreateProgram();
  glAttachShader(id_, vertex);
  glAttachShader(id_, fragment);
  glLinkProgram(id_);
  int good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (good) return;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(id_, static_cast<int>(log.size()), nullptr, log.data());
  glDeleteProgram(id_);
  throw std::runtime_error(names + " cannot be linked: " + log.data());
}

Program::~Program() { glDeleteProgram(id_); }

void Program::use() const { glUseProgram(id_); }
void Program::set(const char* name, float value) const { glUniform1f(glGetUniformLocation(id_, name), value); }
void Program::set(const char* name, int value) const { glUniform1i(glGetUniformLocation(id_, name), value); }
void Program::set(const char* name, const Eigen::Vector2f& value) const {
  glUniform2fv(glGetUniformLocation(id_, name), 1, value.data());
}
void Program::set(const char* name, const Eigen::Vector3f& value) const {
  glUniform3fv(glGetUniformLocation(id_, name), 1, value.data());
}
void Program::set(const uniform_t& u) const {
  const int at = glGetUniformLocation(id_, u.name.c_str());
  if (u.count == 1) glUniform1fv(at, 1, u.values);
  if (u.count == 2) glUniform2fv(at, 1, u.values);
  if (u.count == 3) glUniform3fv(at, 1, u.values);
  if (u.count == 4) glUniform4fv(at, 1, u.values);
}
void Program::set(const char* name, const Eigen::Matrix4f& value) const {
  glUniformMatrix4fv(glGetUniformLocation(id_, name), 1, GL_FALSE, value.data());
}

}  // namespace tactus::visual
