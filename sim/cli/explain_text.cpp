#include <algorithm>
#include <cmath>
#include <ostream>

#include "model/stages/depth_encode.hpp"
#include "model/stages/multisample.hpp"
#include "sim/cli/explain_output.hpp"
#include "sim/study/explain/verify.hpp"

namespace halfplane::explain {
namespace {

constexpr std::size_t kLabel = 18;  // characters before the figures of a line
constexpr std::size_t kMostSteps = 400;

std::string label_text(std::string_view text) { return left_aligned("    " + std::string(text), kLabel); }

std::string fixed_signed(double value, int decimals) { return (value < 0 ? "" : "+") + fixed(value, decimals); }

std::string place_text(const PixelHistory& sample) {
  return fixed(std::ldexp(sample.place.x, -kPatternFraction), 4) + ' ' +
         fixed(std::ldexp(sample.place.y, -kPatternFraction), 4);
}

/// Prints the common part of entry `i` of a pixel's samples.
void print_title(std::ostream& out, PixelSamples pixel, std::size_t i, const Scene& scene) {
  const Entry& entry = pixel.front().history[i];
  out << "  " << (entry.primitive ? "#" + std::to_string(*entry.primitive) : std::string("--")) << ' '
      << kKindNames[static_cast<std::size_t>(entry.kind)];
  if (entry.piece != 0) out << ", piece " << entry.piece;
  if (entry.is_cut) out << ", clipped";
  out << ", command " << entry.draw;
  if (const auto* draw = std::get_if<Draw>(&scene.commands[entry.draw]); draw != nullptr && draw->line != 0)
    out << " (line " << draw->line << ")";
  if (pixel.size() > 1) {
    const auto is_written = [i](const PixelHistory& p) { return p.history[i].outcome.verdict == Verdict::written; };
    out << ": written in " << std::ranges::count_if(pixel, is_written) << " of " << pixel.size() << " samples\n";
    return;
  }
  out << ": " << info(entry.outcome.verdict).name << " at " << info(entry.outcome.stage).name << '\n'
      << label_text("why") << entry.outcome.why << '\n';
}

void print_corners(std::ostream& out, const Entry& entry, const Widths& widths, int depth_bits) {
  for (std::size_t i = 0; i < entry.corners.size(); ++i) {
    const SnappedVertex& v = entry.corners[i];
    out << label_text(i == 0 ? "corners" : "") << i << ": " << fixed(std::ldexp(v.x, -widths.grid_bits), 4) << ' '
        << fixed(std::ldexp(v.y, -widths.grid_bits), 4) << " pixels, depth "
        << hex_text(v.code[kDepthPlane], depth_bits);
    if (entry.golden && entry.golden->outline && entry.golden->outline->corners == entry.corners.size() &&
        !entry.is_cut)
      out << "  (unsnapped " << fixed(entry.golden->outline->x[i], 6) << ' ' << fixed(entry.golden->outline->y[i], 6)
          << ')';
    out << '\n';
  }
  if (entry.kind == Kind::triangle && !entry.corners.empty())
    out << label_text("area") << entry.area << " square subpixels, twice the triangle's: "
        << (entry.area > 0   ? "clockwise"
            : entry.area < 0 ? "counter-clockwise"
                             : "none")
        << " as seen\n";
}

void print_edges(std::ostream& out, const Entry& entry, const Widths& widths, FillRule rule) {
  for (std::size_t i = 0; i < entry.edges.size(); ++i) {
    const EdgeFigure& e = entry.edges[i];
    out << label_text(i == 0 ? "edges" : "") << e.from << "->" << e.to << ' ' << left_aligned(std::string(e.side), 7)
        << hex_text(static_cast<std::uint64_t>(e.value), e.bits) << " = " << e.value << ", really "
        << fixed(std::ldexp(static_cast<double>(e.exact), -2 * widths.grid_bits), 6) << " square pixels, "
        << (e.value >= 0 ? "inside" : "outside");
    if (e.is_tie())
      out << ": exactly on it; a " << e.side << " edge " << (e.owns_ties ? "owns" : "does not own")
          << " its samples (fill rule " << name_of(rule) << ")";
    out << '\n';
  }
  if (entry.golden && !entry.golden->edges.empty()) {
    out << label_text("  golden");
    for (const double edge : entry.golden->edges) out << fixed(edge, 6) << "  ";
    out << "square pixels, unsnapped, by the corner opposite\n";
  }
}

void print_planes(std::ostream& out, const Entry& entry) {
  for (const PlaneFigure& p : entry.planes) {
    out << label_text(p.name) << fixed(std::ldexp(static_cast<double>(p.unrounded), -p.guard_bits), 4) << " -> "
        << hex_text(p.code, p.bits) << " = " << p.code << "; exact " << fixed(to_real(p.oracle), 4);
    if (p.golden) out << ", golden " << fixed(*p.golden, 4);
    if (p.parts) {
      const auto lsb = [](std::int64_t part) {
        return fixed_signed(std::ldexp(static_cast<double>(part), -exact::kGridBits), 4);
      };
      out << "; off by " << lsb(p.parts->snap + p.parts->interpolation + p.parts->storage) << " LSB: snap "
          << lsb(p.parts->snap) << ", interpolation " << lsb(p.parts->interpolation) << ", storage "
          << lsb(p.parts->storage);
    }
    out << '\n';
  }
}

std::string texel_text(const Texel& c) {
  return std::to_string(c[0]) + ' ' + std::to_string(c[1]) + ' ' + std::to_string(c[2]) + ' ' + std::to_string(c[3]);
}

void print_surface(std::ostream& out, const SurfaceFigure& figure) {
  const SurfaceSample& s = figure.sample;
  if (figure.is_lit)
    out << label_text("light") << "normal " << s.normal[0] << ' ' << s.normal[1] << ' ' << s.normal[2] << ", N.L "
        << fixed(std::ldexp(s.light.diffuse, -kLightFraction), 4) << ", highlight "
        << fixed(std::ldexp(s.light.specular, -kLightFraction), 4) << '\n';
  if (s.fog_q != 0)
    out << label_text("fog") << "Q " << s.fog_q << ", " << fixed(std::ldexp(s.fog, -kFogFactorBits), 4)
        << " of the colour is left\n";
  if (figure.texture.empty()) {
    out << label_text("own colour") << texel_text(s.primitive) << '\n';
    return;
  }
  out << label_text("texture") << figure.texture << " at " << fixed(s.coordinate[0], 4) << ' '
      << fixed(s.coordinate[1], 4) << " texels, level " << fixed(std::ldexp(s.lod, -kLodFraction), 3) << ", "
      << (figure.filter.is_linear ? "linear" : "nearest") << (figure.filter.is_between ? " on two levels" : "") << '\n';
  for (const TexelFigure& t : figure.texels) {
    out << label_text("") << "level " << t.level << (t.is_border ? " border by texel " : " texel ") << t.x << ' ' << t.y
        << ", weight " << fixed(std::ldexp(t.weight, -24), 6) << ": " << texel_text(t.color);
    if (t.address) out << ", byte " << hex_text(*t.address, 32);
    out << '\n';
  }
}

void print_line_steps(std::ostream& out, std::string_view name, const std::vector<LineStep>& steps) {
  for (std::size_t i = 0; i < std::min(steps.size(), kMostSteps); ++i) {
    const LineStep& s = steps[i];
    out << label_text(i == 0 ? name : "") << "step " << s.step << " pixel " << s.x << ' ' << s.y << "  error "
        << s.error << " -> " << (s.moves ? "diagonal" : "straight") << '\n';
  }
  if (steps.size() > kMostSteps) out << label_text("") << "... " << steps.size() - kMostSteps << " more\n";
}

void print_line(std::ostream& out, const LineFigure& line) {
  out << label_text("line") << kLineRuleNames[static_cast<std::size_t>(line.rule)] << ", along "
      << (line.is_x_major ? 'x' : 'y') << ": D " << line.major << ", d " << line.minor << " subpixels\n";
  for (const LineWalk& walk : line.walks)
    print_line_steps(out, kLineRuleNames[static_cast<std::size_t>(walk.rule)], walk.steps);
  print_line_steps(out, "book: p", line.bresenham);
  print_line_steps(out, "book: 2F", line.midpoint);
}

void print_triangle_steps(std::ostream& out, const std::vector<TriangleStep>& steps) {
  for (std::size_t i = 0; i < std::min(steps.size(), kMostSteps); ++i) {
    const TriangleStep& s = steps[i];
    out << label_text(i == 0 ? "steps" : "") << "pixel " << s.x << ' ' << s.y << "  edges " << s.value[0] << ' '
        << s.value[1] << ' ' << s.value[2];
    if (s.covered) out << "  covered, depth " << s.depth.code;
    out << '\n';
  }
  if (steps.size() > kMostSteps) out << label_text("") << "... " << steps.size() - kMostSteps << " more\n";
}

void print_operations(std::ostream& out, const Entry& entry) {
  for (const OperationStep& step : entry.operations) {
    out << label_text(step.name);
    for (const Figure& f : step.figures) {
      out << f.name << ' ';
      if (f.bits == 0) out << f.text;
      for (std::size_t i = 0; i < f.values.size(); ++i)
        out << (i == 0 ? "" : " ")
            << (f.values.size() == 1 ? hex_text(f.values[i], f.bits) : std::to_string(f.values[i]));
      out << "  ";
    }
    if (step.passes) out << (*step.passes ? "passes" : "fails");
    out << '\n';
  }
}

void print_hardware(std::ostream& out, const HardwareFigure& figure, const PixelHistory& pixel, const Explanation& all,
                    const Widths& widths) {
  if (figure.hiz) {
    const int bits = widths.depth().code.bits;
    out << label_text("HiZ") << "nearest of the primitive " << hex_text(figure.hiz->nearest, bits)
        << ", farthest of the tile " << hex_text(figure.hiz->farthest, bits) << ": "
        << (figure.hiz->rejects ? "left out" : "let through") << '\n';
  }
  out << label_text("packets");
  for (const PacketId& id : figure.packets) {
    const RecordedPacket& packet = all.packets.at(id);
    out << info(id.first).name << '#' << id.second;
    if (packet.model_cycle) out << " @" << *packet.model_cycle;
    if (pixel.rtl && packet.rtl_cycle && packet.rtl_cycle != packet.model_cycle)
      out << " (RTL @" << *packet.rtl_cycle << ')';
    out << "  ";
  }
  out << '\n';
  if (!pixel.rtl) return;
  std::size_t compared = 0;
  for (const PacketId& id : figure.packets) {
    const RecordedPacket& packet = all.packets.at(id);
    if (packet.rtl.empty()) {
      out << label_text("RTL") << info(id.first).name << '#' << id.second << " never came\n";
      continue;
    }
    ++compared;
    for (const std::string& field : differing_fields(id, packet, widths))
      out << label_text("RTL") << info(id.first).name << '#' << id.second << " differs: " << field << '\n';
  }
  out << label_text("RTL") << compared << " packets compared\n";
}

/// Prints the result of a primitive at one sample; most pixels have only one.
void print_sample(std::ostream& out, const Entry& entry, const PixelHistory& sample, const Explanation& all,
                  const Widths& widths) {
  if (all.samples > 1)
    out << label_text("sample " + std::to_string(sample.sample)) << "at " << place_text(sample) << ": "
        << info(entry.outcome.verdict).name << " at " << info(entry.outcome.stage).name << ", " << entry.outcome.why
        << '\n';
  print_edges(out, entry, widths, all.fill_rule);
  if (entry.oracle)
    out << label_text("oracle") << (entry.oracle->covers ? "covers" : "does not cover")
        << (entry.oracle->is_on_border ? ", on the border" : "") << "; golden "
        << (entry.golden ? golden_verdict(*entry.golden) : "none") << '\n';
  if (entry.line && sample.sample == 0) print_line(out, *entry.line);
  print_triangle_steps(out, entry.steps);
  if (entry.shaded_at)
    out << label_text("colour from")
        << (*entry.shaded_at == kAtCentre
                ? std::string("the pixel's centre")
                : "sample " + std::to_string(*entry.shaded_at) + ", the first that is covered; the centre is not")
        << '\n';
  print_planes(out, entry);
  if (entry.surface) print_surface(out, *entry.surface);
  print_operations(out, entry);
  if (entry.hardware) print_hardware(out, *entry.hardware, sample, all, widths);
}

void print_final(std::ostream& out, std::string_view label, const Stored& model, const GoldenStored& golden,
                 int depth_bits, int color_bits) {
  out << "  " << left_aligned(std::string(label), kLabel - 2) << "model depth " << hex_text(model.depth, depth_bits)
      << " colour " << hex_text(model.color, color_bits);
  if (model.stencil != 0) out << " stencil " << hex_text(model.stencil, 8);
  if (model.owner >= 0) out << " of #" << model.owner;
  out << "; golden depth " << fixed(golden.depth, 3) << " = " << hex_text(golden.rounded.depth, depth_bits)
      << " colour " << hex_text(golden.rounded.color, color_bits);
  if (golden.rounded.owner >= 0) out << " of #" << golden.rounded.owner;
}

}  // namespace

void print_pixel(std::ostream& out, PixelSamples pixel, const Explanation& all, const Scene& scene,
                 const Config& config) {
  const Widths widths = derive_widths(config);
  const int depth_bits = DepthEncode(config, scene.planes).format().bits;
  const int color_bits = config.color_format == ColorFormat::rgb565 ? 16 : 32;
  const PixelHistory& first = pixel.front();
  out << "pixel " << first.at.x << ' ' << first.at.y << ", tile " << (first.at.x >> widths.tile_shift) << ' '
      << (first.at.y >> widths.tile_shift) << '\n';
  for (std::size_t i = 0; i < first.history.size(); ++i) {
    print_title(out, pixel, i, scene);
    print_corners(out, first.history[i], widths, widths.depth().code.bits);
    for (const PixelHistory& sample : pixel) print_sample(out, sample.history[i], sample, all, widths);
  }
  if (first.resolved) {
    for (const PixelHistory& sample : pixel) {
      print_final(out, "sample " + std::to_string(sample.sample), sample.model, sample.golden, depth_bits, color_bits);
      out << '\n';
    }
    print_final(out, "final", first.resolved->model, first.resolved->golden, depth_bits, color_bits);
    out << ": the mean of their colours, depth and owner of sample 0";
  } else {
    print_final(out, "final", first.model, first.golden, depth_bits, color_bits);
  }
  if (first.rtl)
    out << "; RTL depth " << hex_text(first.rtl->depth, depth_bits) << " colour "
        << hex_text(first.rtl->color, color_bits);
  out << '\n';
}

}  // namespace halfplane::explain
