// A vertex and a fragment shader, compiled and linked.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <tactus/uniform_t.hpp>
#include <vector>

namespace tactus::visual {

// A piece of shader source; error messages name it and count its lines from 1.
struct ShaderPiece {
  std::string name;
  std::string text;
};

class Program {
 public:
  // Compiles concatenated pieces, after "#version 330 core" and the defines. The version line of a piece is
  // ignored.
  Program(const std::vector<ShaderPiece>& vertex, const std::vector<ShaderPiece>& fragment,
          const std::string& defines);
  // Compiles shaders/NAME.vert and shaders/NAME.frag, with `defines` ("#define A 1\n...") after the version line
  // of both. Throws std::runtime_error that names file and line of every error.
  explicit Program(const std::string& name, const std::string& defines = "");
  // Compiles these sources; error messages use these names.
  Program(const std::string& vertex_name, std::string_view vertex, const std::string& fragment_name,
          std::string_view fragment, const std::string& defines = "");
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const;
  unsigned id() const { return id_; }
  // Sets a uniform of the program in use. An unknown name is not an error: the compiler may have removed it.
  void set(const char* name, float value) const;
  void set(const char* name, int value) const;
  void set(const char* name, const Eigen::Vector2f& value) const;
  void set(const char* name, const Eigen::Vector3f& value) const;
  void set(const char* name, const Eigen::Matrix4f& value) const;
  void set(const uniform_t& uniform) const;

 private:
  void link(unsigned vertex, unsigned fragment, const std::string& names);
  unsigned id_ = 0;
};

}  // namespace tactus::visual
