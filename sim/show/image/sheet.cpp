// Layout of a sheet: from the top of a cell its caption, picture, legend and note.
#include <algorithm>

#include "color_map.hpp"
#include "panel.hpp"

namespace halfplane {
namespace {

constexpr Rgb kBackground{0x17, 0x18, 0x1c};
constexpr Rgb kFrame{0x4a, 0x4e, 0x57};
constexpr Rgb kText{0xec, 0xee, 0xf2};
constexpr Rgb kDim{0xa6, 0xab, 0xb5};

// All in pixels.
constexpr int kMargin = 24;  // around the sheet and between cells
constexpr int kGap = 8;      // between the parts of a cell
constexpr int kText2 = 2;    // font scale of everything but the title
constexpr int kTitleScale = 3;
constexpr int kLine = text_height(kText2) + 4;
constexpr int kBarHeight = 14;
constexpr int kTickHeight = 5;
constexpr int kSwatch = 14;
constexpr int kEntryGap = 22;       // between two entries of a legend
constexpr int kColumnGap = 28;      // between the columns of a text
constexpr int kMinCellWidth = 480;  // captions and statistics fit
constexpr int kSmallPicture = 480;  // pictures are enlarged while they stay within it

int enlargement(const Picture& picture) {
  const int side = std::max({picture.width, picture.height, 1});
  return std::max(1, kSmallPicture / side);
}

struct Cells {
  int width = kMinCellWidth;
  int picture_height = 0, legend_height = 0, note_height = 0;
  int text_height = 0;  // of the highest panel without a picture, its caption included
  [[nodiscard]] int height() const {
    const int legend = legend_height == 0 ? 0 : legend_height + kGap;
    const int note = note_height == 0 ? 0 : note_height + kGap;
    return std::max(kLine + kGap + picture_height + legend + note, text_height);
  }
};

// Draws the entries in as many lines as they need, or only measures when `sheet` is null. Returns the height.
int flow_entries(Picture* sheet, const std::vector<LegendEntry>& entries, int left, int top, int width) {
  int x = left, y = top;
  for (const LegendEntry& entry : entries) {
    const int advance = kSwatch + kGap + text_width(entry.label, kText2);
    if (x > left && x + advance > left + width) {
      x = left;
      y += kLine;
    }
    if (sheet != nullptr) {
      fill_rect(*sheet, {x, y + 1, kSwatch, kSwatch}, entry.color);
      frame_rect(*sheet, {x, y + 1, kSwatch, kSwatch}, kFrame);
      draw_text(*sheet, x + kSwatch + kGap, y, entry.label, kText, kText2);
    }
    x += advance + kEntryGap;
  }
  return y + kLine - top;
}

// The number at the end of interval i of `ticks`.
std::string tick_label(const ScaleLegend& scale, int i, int ticks) {
  const double low = scale.diverging ? -scale.range : 0;
  return short_number(low + (scale.range - low) * i / ticks);
}

// Four intervals where their labels leave room between them, otherwise two.
int tick_intervals(const ScaleLegend& scale, int bar) {
  int widest = 0;
  for (int i = 0; i <= 4; ++i) widest = std::max(widest, text_width(tick_label(scale, i, 4), kText2));
  return bar / 4 >= widest * 3 / 2 + kGap ? 4 : 2;  // 3/2: the first label is not centred
}

void draw_ticks(Picture& sheet, const ScaleLegend& scale, int left, int top, int bar) {
  const int ticks = tick_intervals(scale, bar);
  for (int i = 0; i <= ticks; ++i) {
    const int x = left + i * (bar - 1) / ticks;
    draw_line(sheet, x, top, x, top + kTickHeight, kDim);
    const std::string label = tick_label(scale, i, ticks);
    const int text_x = i == 0 ? left : x - text_width(label, kText2) / 2;  // the first stays inside its cell
    const std::string shown = i == ticks ? label + " " + scale.unit : label;
    draw_text(sheet, text_x, top + kTickHeight + 3, shown, kDim, kText2);
  }
}

void draw_scale(Picture& sheet, const ScaleLegend& scale, int left, int top, int width) {
  const std::string_view rest = "not compared";
  const int bar = width - text_width(rest, kText2) - kSwatch - kGap - kEntryGap;
  for (int i = 0; i < bar; ++i) {
    const double part = (i + 0.5) / bar;
    const Rgb color = scale.diverging ? diverging_color(2 * part - 1) : sequential_color(part);
    fill_rect(sheet, {left + i, top, 1, kBarHeight}, color);
  }
  frame_rect(sheet, {left - 1, top - 1, bar + 2, kBarHeight + 2}, kFrame);
  draw_ticks(sheet, scale, left, top + kBarHeight, bar);
  const int x = left + bar + kEntryGap;
  fill_rect(sheet, {x, top, kSwatch, kSwatch}, kNotCompared);
  frame_rect(sheet, {x, top, kSwatch, kSwatch}, kFrame);
  draw_text(sheet, x + kSwatch + kGap, top, rest, kDim, kText2);
}

int legend_height(const Legend& legend, int width) {
  if (const auto* entries = std::get_if<std::vector<LegendEntry>>(&legend))
    return flow_entries(nullptr, *entries, 0, 0, width);
  if (std::holds_alternative<ScaleLegend>(legend)) return kBarHeight + kTickHeight + 3 + kLine;
  return 0;
}

std::vector<std::string> split_at_tabs(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == '\t')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

// Lines with tabs form a table: the first column flush left, figures flush right.
void draw_lines(Picture& sheet, const Panel& panel, const Rect& box) {
  std::vector<int> widths;
  for (const std::string& line : panel.lines) {
    const auto fields = split_at_tabs(line);
    if (fields.size() < 2) continue;
    widths.resize(std::max(widths.size(), fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i) widths[i] = std::max(widths[i], text_width(fields[i], kText2));
  }
  int y = box.y;
  for (const std::string& line : panel.lines) {
    const auto fields = split_at_tabs(line);
    draw_text(sheet, box.x, y, fit_text(fields[0], box.width, kText2), kText, kText2);
    int right = widths.empty() ? 0 : box.x + widths[0];
    for (std::size_t i = 1; i < fields.size(); ++i) {
      right += kColumnGap + widths[i];
      draw_text(sheet, right - text_width(fields[i], kText2), y, fields[i], kText, kText2);
    }
    y += kLine + 2;
  }
}

void draw_cell(Picture& sheet, const Panel& panel, const Cells& cells, int left, int top) {
  draw_text(sheet, left, top, fit_text(panel.caption, cells.width, kText2), kText, kText2);
  int y = top + kLine + kGap;
  if (panel.picture.rgb.empty()) {
    draw_lines(sheet, panel, {left, y, cells.width, top + cells.height() - y});
    return;
  }
  const int scale = enlargement(panel.picture);
  const int width = scale * panel.picture.width, height = scale * panel.picture.height;
  const int x = left + (cells.width - width) / 2;
  draw_picture(sheet, panel.picture, x, y, scale);
  frame_rect(sheet, {x - 1, y - 1, width + 2, height + 2}, kFrame);
  y += cells.picture_height + kGap;
  if (const auto* entries = std::get_if<std::vector<LegendEntry>>(&panel.legend))
    flow_entries(&sheet, *entries, left, y, cells.width);
  if (const auto* bar = std::get_if<ScaleLegend>(&panel.legend)) draw_scale(sheet, *bar, left, y, cells.width);
  y += cells.legend_height + (cells.legend_height > 0 ? kGap : 0);
  draw_text(sheet, left, y, fit_text(panel.note, cells.width, kText2), kDim, kText2);
}

}  // namespace

Picture compose_sheet(std::string_view title, std::span<const Panel> panels, int columns) {
  const auto count = static_cast<int>(panels.size());
  columns = std::clamp(columns, 1, std::max(count, 1));
  const int row_count = (count + columns - 1) / columns;
  int width = kMinCellWidth;
  for (const Panel& panel : panels) width = std::max(width, enlargement(panel.picture) * panel.picture.width);
  std::vector<Cells> rows(static_cast<std::size_t>(row_count));  // a row without legends takes no room for them
  for (int i = 0; i < count; ++i) {
    const Panel& panel = panels[static_cast<std::size_t>(i)];
    Cells& row = rows[static_cast<std::size_t>(i / columns)];
    row.width = width;
    row.picture_height = std::max(row.picture_height, enlargement(panel.picture) * panel.picture.height);
    row.legend_height = std::max(row.legend_height, legend_height(panel.legend, width));
    if (!panel.note.empty()) row.note_height = kLine;
    row.text_height = std::max(row.text_height, kLine + kGap + static_cast<int>(panel.lines.size()) * (kLine + 2));
  }
  int height = kMargin;
  const int title_height = title.empty() ? 0 : text_height(kTitleScale) + kMargin;
  for (const Cells& row : rows) height += row.height() + kMargin;
  Picture sheet(kMargin + columns * (width + kMargin), height + title_height, kBackground);
  draw_text(sheet, kMargin, kMargin, fit_text(title, sheet.width - 2 * kMargin, kTitleScale), kText, kTitleScale);
  int y = kMargin + title_height;
  for (int r = 0; r < row_count; ++r) {
    const Cells& row = rows[static_cast<std::size_t>(r)];
    for (int c = 0; c < columns && r * columns + c < count; ++c)
      draw_cell(sheet, panels[static_cast<std::size_t>(r * columns + c)], row, kMargin + c * (width + kMargin), y);
    y += row.height() + kMargin;
  }
  return sheet;
}

}  // namespace halfplane
