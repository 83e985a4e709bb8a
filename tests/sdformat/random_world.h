// Random valid scenes, from a seed: nested models, frames, joints, includes, merged models, placement frames, and the
// spellings of SDFormat 1.4 to 1.9.
#pragma once

#include <map>
#include <random>
#include <string>
#include <vector>

namespace tactus::test {

class RandomWorld {
 public:
  explicit RandomWorld(std::uint64_t seed);

  // "scene.sdf" and the files that it includes.
  const std::map<std::string, std::string>& files() const { return files_; }

 private:
  // The names that a <pose> or a joint may refer to, in one world or model.
  struct Scope {
    int version = 9;
    std::vector<std::string> frames = {};                        // of every kind
    std::vector<std::pair<std::string, std::string>> ends = {};  // of joints: name, and the link that it moves with
  };

  double number(double low, double high);
  std::string numbers(int count, double low, double high);
  bool chance(double probability) { return number(0, 1) < probability; }
  int below(std::size_t count) { return static_cast<int>(random_() % count); }
  std::string name(const std::string& kind) { return kind + std::to_string(++names_); }

  std::string pose(const Scope* scope);
  // relative_to="..." in the spelling of the version, or nothing.
  std::string frame_attribute(const Scope& scope);
  std::string geometry();
  std::string colour();
  std::string material();
  std::string inertial();
  std::string link(const std::string& link_name, Scope& scope);
  std::string joint(Scope& scope);
  std::string axis(const std::string& element, const Scope& scope);
  std::string frame(Scope& scope);
  std::string light();
  // inside: of the scope that contains it; nullptr: the outermost element of a file.
  std::string model(const std::string& model_name, int version, int depth, const Scope* inside, std::string& first_link);
  std::string include(Scope& scope, bool merge);
  std::string world();

  std::mt19937_64 random_;
  int names_ = 0;
  bool may_place_ = true;  // by a placement frame
  std::map<std::string, std::string> files_;
};

}  // namespace tactus::test
