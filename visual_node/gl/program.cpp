#include "visual_node/gl/program.h"

#include <epoxy/gl.h>

#include <array>
#include <regex>
#include <stdexcept>
#include <vector>

#include "visual_node/gl/shader_text.h"

namespace tactus::visual {
namespace {

// Drivers begin a message with "0:12(5): " (Mesa) or "0(12) : " (NVIDIA) or "ERROR: 0:12: ": string number and
// line.
std::string with_file(const std::string& log, const std::string& name) {
  static const std::regex position(R"((^|\n)(ERROR: )?0[:(](\d+)\)?(\(\d+\))?\s*:)");
  std::string text = std::regex_replace(log, position, "$1" + name + ":$3:");
  while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) text.pop_back();
  return text;
}

// The defines go after the version line; #line keeps the numbers those of the file.
std::string with_defines(std::string_view source, const std::string& defines) {
  const auto first = source.find('\n') + 1;
  return std::string(source.substr(0, first)) + defines + "#line 2\n" + std::string(source.substr(first));
}

class Shader {
 public:
  Shader(unsigned kind, const std::string& name, std::string_view source, const std::string& defines)
      : id_(glCreateShader(kind)) {
    if (source.empty()) throw std::runtime_error("there is no shader " + name);
    const std::string text = with_defines(source, defines);
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
    throw std::runtime_error("a shader does not compile: " + with_file(log, name));
  }
  ~Shader() { glDeleteShader(id_); }
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  unsigned id() const { return id_; }

 private:
  unsigned id_;
};

}  // namespace

Program::Program(const std::string& name, const std::string& defines)
    : Program(name + ".vert", shader_text(name + ".vert"), name + ".frag", shader_text(name + ".frag"), defines) {}

Program::Program(const std::string& vertex_name, std::string_view vertex, const std::string& fragment_name,
                 std::string_view fragment, const std::string& defines) {
  const Shader v(GL_VERTEX_SHADER, vertex_name, vertex, defines),
      f(GL_FRAGMENT_SHADER, fragment_name, fragment, defines);
  id_ = glCreateProgram();
  glAttachShader(id_, v.id());
  glAttachShader(id_, f.id());
  glLinkProgram(id_);
  int good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (good) return;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(id_, static_cast<int>(log.size()), nullptr, log.data());
  glDeleteProgram(id_);
  throw std::runtime_error(vertex_name + " and " + fragment_name + " do not fit together: " + log.data());
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
void Program::set(const char* name, const Eigen::Matrix4f& value) const {
  glUniformMatrix4fv(glGetUniformLocation(id_, name), 1, GL_FALSE, value.data());
}

}  // namespace tactus::visual
