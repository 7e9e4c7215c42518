// Layout of a sheet: from the top of a cell its caption, picture, legend and note.
#include <algorithm>
#include <cmath>

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
constexpr int kText2 = 2;    // font scale of all text except the title
constexpr int kTitleScale = 3;
constexpr int kLine = text_height(kText2) + 4;
constexpr int kBarHeight = 14;
constexpr int kTickHeight = 5;
constexpr int kSwatch = 14;
constexpr int kEntryGap = 22;       // between two entries of a legend
constexpr int kColumnGap = 28;      // between the columns of a text
constexpr int kMinCellWidth = 480;  // fits captions and statistics
constexpr int kSmallPicture = 480;  // pictures are enlarged up to this size

int enlargement(const Picture& picture) {
  const int side = std::max({picture.width, picture.height, 1});
  return std::max(1, kSmallPicture / side);
}

struct Cells {
  int width = kMinCellWidth;
  int caption_height = kLine, picture_height = 0, legend_height = 0, note_height = 0;
  int text_height = 0;  // of the highest panel without a picture
  [[nodiscard]] int height() const {
    const int legend = legend_height == 0 ? 0 : legend_height + kGap;
    const int note = note_height == 0 ? 0 : note_height + kGap;
    return caption_height + kGap + std::max(picture_height + legend + note, text_height);
  }
};

int block_height(std::string_view text, int width) {
  return text.empty() ? 0 : static_cast<int>(wrap_text(text, width, kText2).size()) * kLine;
}

/// Draws text in as many lines as it needs.
void draw_block(Picture& sheet, int x, int y, std::string_view text, int width, Rgb color) {
  for (const std::string& line : wrap_text(text, width, kText2)) {
    draw_text(sheet, x, y, line, color, kText2);
    y += kLine;
  }
}

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

void draw_ticks(Picture& sheet, const ScaleLegend& scale, int left, int top, int bar, int width) {
  const std::vector<ScaleTick> ticks = scale_ticks(scale, bar);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const ScaleTick& tick = ticks[i];
    const int x = left + static_cast<int>(tick.at * (bar - 1));
    draw_line(sheet, x, top, x, top + kTickHeight, kDim);
    const std::string shown = i + 1 == ticks.size() ? tick.label + " " + scale.unit : tick.label;
    const int text_x = std::clamp(x - text_width(tick.label, kText2) / 2, left,  // all labels stay inside their cell
                                  std::max(left, left + width - text_width(shown, kText2)));
    draw_text(sheet, text_x, top + kTickHeight + 3, shown, kDim, kText2);
  }
}

void draw_scale(Picture& sheet, const ScaleLegend& scale, int left, int top, int width) {
  const int bar = width - text_width(scale.rest, kText2) - kSwatch - kGap - kEntryGap;
  for (int i = 0; i < bar; ++i) {
    const double part = (i + 0.5) / bar;
    const Rgb color = scale.diverging ? diverging_color(2 * part - 1) : sequential_color(part);
    fill_rect(sheet, {left + i, top, 1, kBarHeight}, color);
  }
  frame_rect(sheet, {left - 1, top - 1, bar + 2, kBarHeight + 2}, kFrame);
  draw_ticks(sheet, scale, left, top + kBarHeight, bar, width);
  const int x = left + bar + kEntryGap;
  fill_rect(sheet, {x, top, kSwatch, kSwatch}, kNotCompared);
  frame_rect(sheet, {x, top, kSwatch, kSwatch}, kFrame);
  draw_text(sheet, x + kSwatch + kGap, top, scale.rest, kDim, kText2);
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

// Widths of the columns of a table's lines.
std::vector<int> column_widths(const Panel& panel) {
  std::vector<int> widths;
  for (const std::string& line : panel.lines) {
    const auto fields = split_at_tabs(line);
    if (fields.size() < 2) continue;
    widths.resize(std::max(widths.size(), fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i) widths[i] = std::max(widths[i], text_width(fields[i], kText2));
  }
  return widths;
}

// A table is not wrapped: its cell has its width.
int table_width(const Panel& panel) {
  int width = 0;
  for (const int column : column_widths(panel)) width += column + (width == 0 ? 0 : kColumnGap);
  return width;
}

// Lines with tabs form a table: the first column flush left, figures flush right. Returns the height; draws nothing when
// `sheet` is null.
int draw_lines(Picture* sheet, const Panel& panel, int left, int top, int width) {
  const std::vector<int> widths = column_widths(panel);
  int y = top;
  for (const std::string& line : panel.lines) {
    const auto fields = split_at_tabs(line);
    if (fields.size() < 2) {
      if (sheet != nullptr) draw_block(*sheet, left, y, line, width, kText);
      y += std::max(kLine, block_height(line, width)) + 2;
      continue;
    }
    if (sheet != nullptr) draw_text(*sheet, left, y, fields[0], kText, kText2);
    int right = left + widths[0];
    for (std::size_t i = 1; i < fields.size(); ++i) {
      right += kColumnGap + widths[i];
      if (sheet != nullptr) draw_text(*sheet, right - text_width(fields[i], kText2), y, fields[i], kText, kText2);
    }
    y += kLine + 2;
  }
  return y - top;
}

void draw_cell(Picture& sheet, const Panel& panel, const Cells& cells, int left, int top) {
  draw_block(sheet, left, top, panel.caption, cells.width, kText);
  int y = top + cells.caption_height + kGap;
  if (panel.picture.rgb.empty()) {
    draw_lines(&sheet, panel, left, y, cells.width);
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
  draw_block(sheet, left, y, panel.note, cells.width, kDim);
}

// In whole decades, fewer if there is no room for all.
std::vector<ScaleTick> log_ticks(const ScaleLegend& scale, int bar) {
  const int first = static_cast<int>(std::lround(std::log10(scale.low)));
  const int decades = static_cast<int>(std::lround(std::log10(scale.range / scale.low)));
  for (int step = 1;; ++step) {
    if (decades % step != 0) continue;
    std::vector<ScaleTick> ticks;
    int widest = 0;
    for (int i = 0; i <= decades; i += step) {
      const int power = first + i;
      // "1000" is narrower than "1e+03"
      const std::string number = power > 0 && power < 6 ? "1" + std::string(static_cast<std::size_t>(power), '0')
                                                        : short_number(std::pow(10.0, power));
      const std::string label = (i == 0 && scale.is_cut ? "<" : "") + number;
      ticks.push_back({static_cast<double>(i) / decades, label});
      widest = std::max(widest, text_width(label, kText2));
    }
    if (step == decades || bar / (decades / step) >= widest * 3 / 2 + kGap) return ticks;
  }
}

}  // namespace

std::vector<ScaleTick> scale_ticks(const ScaleLegend& scale, int bar) {
  if (scale.low > 0) return log_ticks(scale, bar);
  const double low = scale.diverging ? -scale.range : 0;
  const auto ticks_of = [&](int intervals) {
    std::vector<ScaleTick> ticks;
    for (int i = 0; i <= intervals; ++i)
      ticks.push_back({static_cast<double>(i) / intervals, short_number(low + (scale.range - low) * i / intervals)});
    return ticks;
  };
  // Four intervals if there is room between their labels, otherwise two.
  std::vector<ScaleTick> four = ticks_of(4);
  int widest = 0;
  for (const ScaleTick& tick : four) widest = std::max(widest, text_width(tick.label, kText2));
  return bar / 4 >= widest * 3 / 2 + kGap ? four : ticks_of(2);  // 3/2: the first label is not centred
}

Picture scale_picture(const ScaleLegend& scale, int width) {
  Picture picture(width, kBarHeight + kTickHeight + 3 + kLine + 2 * kGap, kBackground);
  draw_scale(picture, scale, kGap, kGap, width - 2 * kGap);
  return picture;
}

Picture compose_sheet(std::string_view title, std::span<const Panel> panels, int columns) {
  const auto count = static_cast<int>(panels.size());
  columns = std::clamp(columns, 1, std::max(count, 1));
  const int row_count = (count + columns - 1) / columns;
  int width = kMinCellWidth;
  for (const Panel& panel : panels)
    width = std::max({width, enlargement(panel.picture) * panel.picture.width, table_width(panel)});
  std::vector<Cells> rows(static_cast<std::size_t>(row_count));  // a row without legends has no space for them
  for (int i = 0; i < count; ++i) {
    const Panel& panel = panels[static_cast<std::size_t>(i)];
    Cells& row = rows[static_cast<std::size_t>(i / columns)];
    row.width = width;
    row.picture_height = std::max(row.picture_height, enlargement(panel.picture) * panel.picture.height);
    row.legend_height = std::max(row.legend_height, legend_height(panel.legend, width));
    row.caption_height = std::max(row.caption_height, block_height(panel.caption, width));
    row.note_height = std::max(row.note_height, block_height(panel.note, width));
    row.text_height = std::max(row.text_height, draw_lines(nullptr, panel, 0, 0, width));
  }
  const int sheet_width = kMargin + columns * (width + kMargin);
  constexpr int kTitleLine = text_height(kTitleScale) + 6;
  const auto title_lines =
      title.empty() ? std::vector<std::string>() : wrap_text(title, sheet_width - 2 * kMargin, kTitleScale);
  const int title_height = title.empty() ? 0 : static_cast<int>(title_lines.size()) * kTitleLine - 6 + kMargin;
  int height = kMargin;
  for (const Cells& row : rows) height += row.height() + kMargin;
  Picture sheet(sheet_width, height + title_height, kBackground);
  for (std::size_t i = 0; i < title_lines.size(); ++i)
    draw_text(sheet, kMargin, kMargin + static_cast<int>(i) * kTitleLine, title_lines[i], kText, kTitleScale);
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
