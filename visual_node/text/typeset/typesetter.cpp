#include "visual_node/text/typeset/typesetter.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include <harfbuzz/hb-ot.h>
#include <pango/pangoft2.h>

#include <algorithm>
#include <stdexcept>

#include "lcmtypes/utf8.h"

namespace tactus::visual {
namespace {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
template <class T>
using Owned = std::unique_ptr<T, Unref>;

struct FreeIter {
  void operator()(PangoLayoutIter* iter) const { pango_layout_iter_free(iter); }
};
using Iter = std::unique_ptr<PangoLayoutIter, FreeIter>;

// The direction of its only paragraph.
bool right_to_left(PangoLayout* layout) {
  return pango_layout_line_get_resolved_direction(pango_layout_get_line_readonly(layout, 0)) ==
         PANGO_DIRECTION_RTL;
}

// PANGO_ALIGN_LEFT means the edge at which a paragraph begins (pango_layout_set_auto_dir).
PangoAlignment alignment(TextEdge edge, bool mirrored) {
  const bool right = edge == TextEdge::kRight || (edge == TextEdge::kNatural && mirrored);
  return right != mirrored ? PANGO_ALIGN_RIGHT : PANGO_ALIGN_LEFT;
}

// Drawn as a coloured bitmap, which has no coverage.
bool is_coloured(PangoFont* font) {
  hb_face_t* const face = hb_font_get_face(pango_font_get_hb_font(font));
  return hb_ot_color_has_png(face) != 0;
}

void add_once(std::vector<char32_t>& all, char32_t c) {
  if (std::find(all.begin(), all.end(), c) == all.end()) all.push_back(c);
}

// The characters of a run.
void add_all(std::vector<char32_t>& all, const char* text, int bytes) {
  for (const char* at = text; at < text + bytes; at = g_utf8_next_char(at)) add_once(all, g_utf8_get_char(at));
}

void add_missing(std::vector<char32_t>& missing, PangoLayout* layout) {
  const char* const text = pango_layout_get_text(layout);
  const Iter iter(pango_layout_get_iter(layout));
  do {
    const PangoLayoutRun* const run = pango_layout_iter_get_run_readonly(iter.get());
    if (!run) continue;
    if (run->item->analysis.font && is_coloured(run->item->analysis.font))
      add_all(missing, text + run->item->offset, run->item->length);
    for (int i = 0; i < run->glyphs->num_glyphs; ++i) {
      const PangoGlyph glyph = run->glyphs->glyphs[i].glyph;
      if (glyph != PANGO_GLYPH_EMPTY && glyph & PANGO_GLYPH_UNKNOWN_FLAG)
        add_once(missing, static_cast<char32_t>(glyph & ~static_cast<PangoGlyph>(PANGO_GLYPH_UNKNOWN_FLAG)));
    }
  } while (pango_layout_iter_next_run(iter.get()));
}

// For each byte of the text, the first byte of its cluster: where a cursor may stand.
std::vector<std::size_t> cluster_begins(PangoLayout* layout, const std::string& text) {
  int count = 0;
  const PangoLogAttr* const attributes = pango_layout_get_log_attrs_readonly(layout, &count);
  std::vector<std::size_t> begins;
  std::size_t begin = 0;
  for (int character = 0; begins.size() < text.size(); ++character) {
    if (character < count && attributes[character].is_cursor_position) begin = begins.size();
    const std::string_view rest = std::string_view(text).substr(begins.size());
    begins.insert(begins.end(), std::max<std::size_t>(1, utf8_bytes(rest)), begin);
  }
  return begins;
}

struct Placed {
  Owned<PangoLayout> layout;
  DrawnBlock block;
  int top = 0;  // row of the layout's upper edge within the block: marks may reach above it
};

}  // namespace

struct Typesetter::Fonts {
  Owned<PangoFontMap> map{pango_ft2_font_map_new()};
  Owned<PangoContext> context{pango_font_map_create_context(map.get())};

  Owned<PangoLayout> lay_out(const TextBlock& block) const {
    for (std::string_view rest = block.text; !rest.empty(); rest.remove_prefix(shown_bytes(rest)))
      if (shown_bytes(rest) == 0) throw std::runtime_error("it is not UTF-8, or has a control character");
    Owned<PangoLayout> layout(pango_layout_new(context.get()));
    PangoFontDescription* const font = pango_font_description_new();
    pango_font_description_set_family(font, "sans-serif");
    pango_font_description_set_absolute_size(font, block.size_px * PANGO_SCALE);
    pango_layout_set_font_description(layout.get(), font);
    pango_font_description_free(font);
    pango_layout_set_single_paragraph_mode(layout.get(), TRUE);
    pango_layout_set_width(layout.get(), block.width_px * PANGO_SCALE);
    pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
    pango_layout_set_spacing(layout.get(), block.size_px * PANGO_SCALE / 8);
    pango_layout_set_text(layout.get(), block.text.data(), static_cast<int>(block.text.size()));
    pango_layout_set_alignment(layout.get(), alignment(block.edge, right_to_left(layout.get())));
    return layout;
  }

  Placed place(const TextBlock& block) const {
    Placed placed{lay_out(block), {}, 0};
    PangoRectangle ink, logical, line;
    pango_layout_get_pixel_extents(placed.layout.get(), &ink, &logical);
    pango_layout_line_get_pixel_extents(pango_layout_get_line_readonly(placed.layout.get(), 0), nullptr, &line);
    // A pile of marks is cut two letters above and below its line.
    const int above = std::clamp(logical.y - ink.y, 0, 2 * block.size_px);
    const int below = std::clamp(ink.y + ink.height - logical.y - logical.height, 0, 2 * block.size_px);
    placed.top = above - logical.y;
    placed.block.rows = block.text.empty() ? 0 : above + logical.height + below;
    placed.block.line_rows = std::min(placed.block.rows, above + line.height);
    placed.block.right_to_left = right_to_left(placed.layout.get());
    return placed;
  }
};

Typesetter::Typesetter() : fonts_(std::make_unique<Fonts>()) {}
Typesetter::~Typesetter() = default;

DrawnText Typesetter::draw(const TextRequest& request) {
  std::vector<Placed> all;
  DrawnText text;
  int width = 0;
  std::int64_t rows = 0;
  for (const TextBlock& block : request.blocks) {
    all.push_back(fonts_->place(block));
    add_missing(text.missing, all.back().layout.get());
    if (request.measure) all.back().block.rows = std::min(all.back().block.rows, kMaxTextRows);
    rows += all.back().block.rows;
    width = std::max(width, block.width_px);
  }
  if (!text.missing.empty()) return text;
  if (request.measure) {
    for (const Placed& placed : all) text.blocks.push_back(placed.block);
    return text;
  }
  const bool large =
      rows > kMaxTextRows || static_cast<std::size_t>(rows) * static_cast<std::size_t>(width) > kMaxTextPixels;
  if (large) throw std::runtime_error("it is larger than a picture: shorten it");
  text.picture = {width, static_cast<int>(rows),
                  std::vector<std::uint8_t>(static_cast<std::size_t>(rows) * static_cast<std::size_t>(width))};
  int first_row = 0;
  for (Placed& placed : all) {
    placed.block.first_row = first_row;
    if (placed.block.rows > 0) {
      // Only the rows of the block, so that no mark is drawn over its neighbours.
      FT_Bitmap target{};
      target.rows = static_cast<unsigned>(placed.block.rows);
      target.width = static_cast<unsigned>(width);
      target.pitch = width;
      target.buffer = text.picture.coverage.data() + static_cast<std::ptrdiff_t>(first_row) * width;
      target.num_grays = 256;
      target.pixel_mode = FT_PIXEL_MODE_GRAY;
      pango_ft2_render_layout(&target, placed.layout.get(), 0, placed.top);
    }
    first_row += placed.block.rows;
    text.blocks.push_back(placed.block);
  }
  return text;
}

std::vector<TextCluster> Typesetter::clusters(const TextBlock& block) {
  const Owned<PangoLayout> layout = fonts_->lay_out(block);
  const std::vector<std::size_t> begins = cluster_begins(layout.get(), block.text);
  std::vector<TextCluster> found;
  const Iter iter(pango_layout_get_iter(layout.get()));
  int line = 0;
  const PangoLayoutLine* current = pango_layout_iter_get_line_readonly(iter.get());
  do {
    if (const PangoLayoutLine* now = pango_layout_iter_get_line_readonly(iter.get()); now != current)
      current = now, ++line;
    if (!pango_layout_iter_get_run_readonly(iter.get())) continue;  // the end of a line
    PangoRectangle logical;
    pango_layout_iter_get_cluster_extents(iter.get(), nullptr, &logical);
    const std::size_t begin = begins[static_cast<std::size_t>(pango_layout_iter_get_index(iter.get()))];
    const int x = PANGO_PIXELS(logical.x), width = PANGO_PIXELS(logical.width);
    // A mark may be a glyph of its own, before or after its letter.
    const auto known =
        std::find_if(found.begin(), found.end(), [&](const TextCluster& c) { return c.first_byte == begin; });
    if (known == found.end())
      found.push_back({begin, x, width, line});
    else
      known->x_px = std::min(known->x_px, x), known->width_px += width;
  } while (pango_layout_iter_next_cluster(iter.get()));
  return found;
}

}  // namespace tactus::visual
