// Tests of text pictures on the graphics device.
#include "visual_node/gl/labels.h"

#include <catch2/catch.hpp>
#include <random>

#include "tests/visual_node/support/offscreen.h"

using namespace tactus;
using namespace tactus::test;
using namespace tactus::visual;

namespace {

std::shared_ptr<const TextPicture> random_text(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  TextPicture text{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    text.coverage.push_back(static_cast<std::uint8_t>(random() % 3 ? random() % 256 : random() % 2 * 255));
  return std::make_shared<TextPicture>(std::move(text));
}

// A black picture with these labels.
Image drawn(Renderer& renderer, std::vector<Label> labels) {
  DrawList list;
  list.labels = std::move(labels);
  return draw(renderer, list);
}

}  // namespace

TEST_CASE("Each pixel of a label is its colour times the coverage of its row and column") {
  display();
  Renderer renderer(kWidth, kHeight, 16);
  const auto text = random_text(37, 50, 4);  // an odd width: rows are not aligned to four bytes
  const Image image = drawn(renderer, {{text, 0, 20, 100, 200, 1, 1, 1}, {text, 20, 30, 300, 10, 1, 0.5f, 0}});
  const auto coverage = [&](int column, int row) {
    return text->coverage[static_cast<std::size_t>(row * 37 + column)];
  };
  for (int row = 0; row < 50; ++row)
    for (int column = 0; column < 37; ++column) {
      const double c = coverage(column, row);
      const Eigen::Vector3d pixel =
          row < 20 ? image.at(100 + column, 200 + row) : image.at(300 + column, 10 + row - 20);
      const Eigen::Vector3d wanted = row < 20 ? Eigen::Vector3d(c, c, c) : Eigen::Vector3d(c, c / 2, 0);
      REQUIRE((pixel - wanted).cwiseAbs().maxCoeff() <= kTolerance);
    }
  CHECK(image.at(100 + 37, 200).norm() == 0);
  CHECK(image.at(100, 200 + 20).norm() == 0);
}

TEST_CASE("A label beyond the picture is cut, and one with impossible rows is left out") {
  display();
  Renderer renderer(kWidth, kHeight, 16);
  const auto text = random_text(60, 40, 5);
  const Image cut =
      drawn(renderer, {{text, 0, 40, static_cast<float>(kWidth - 10), static_cast<float>(kHeight - 5)}});
  for (int row = 0; row < 5; ++row)
    CHECK(cut.at(kWidth - 10, kHeight - 5 + row).x() ==
          Approx(text->coverage[static_cast<std::size_t>(row * 60)]).margin(kTolerance));
  const Image none = drawn(renderer, {{text, 30, 11, 0, 0},
                                      {text, -1, 5, 0, 0},
                                      {text, 0, 0, 0, 0},
                                      {nullptr, 0, 5, 0, 0},
                                      {std::make_shared<TextPicture>(TextPicture{9, 9, {1}}), 0, 5, 0, 0}});
  for (int x = 0; x < 60; ++x) CHECK(none.at(x, 3).norm() == 0);
}

TEST_CASE("A text picture is uploaded once, and removed when no label uses it") {
  display();
  const PictureTarget target(kWidth, kHeight);
  target.bind();
  Labels labels;
  const auto first = random_text(8, 8, 1), second = random_text(8, 8, 2);
  for (int i = 0; i < 3; ++i) {
    labels.draw({{first, 0, 4}, {first, 4, 4}, {second, 0, 8}}, kWidth, kHeight);
    CHECK(labels.stored() == 2);
  }
  labels.draw({{second, 0, 8}}, kWidth, kHeight);
  CHECK(labels.stored() == 1);
  CHECK(first.use_count() == 1);
  labels.draw({}, kWidth, kHeight);
  CHECK(labels.stored() == 0);
}
