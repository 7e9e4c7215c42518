// The operations on a fragment, one after the other, with what each finds and leaves: the table behind "colours before and
// after". The arithmetic is the model's own (model/stages/fragment_ops.hpp); what all of them leave is held against it.
#pragma once

#include "history.hpp"
#include "model/host/primitives.hpp"

namespace halfplane::explain {

/// A fragment on its way through the table.
struct FragmentAtWork {
  const DrawContext& context;
  const SurfaceFigure* surface = nullptr;  ///< what its colour is, where it is no plane's
  std::uint32_t plane_depth = 0;           ///< code of the plane
  std::array<std::uint32_t, 4>
      color{};               ///< R, G, B, A, 8 bits each: the primitive's own, then what operations make of it
  std::uint32_t depth = 0;   ///< code as it is stored
  std::uint32_t packed = 0;  ///< colour as it is stored
  Stored& stored;            ///< at its pixel
  Pixel at;
  bool is_back = false;  ///< of a triangle that shows its back
  bool passes_stencil = true, passes_depth = true;
  bool passes_alpha = true;
  std::uint32_t primitive = 0;
  std::uint32_t sample = 0;  ///< of its pixel
};

/// Runs the table. Returns what became of the fragment.
[[nodiscard]] Outcome run_operations(FragmentAtWork& fragment, std::vector<OperationStep>& steps);

}  // namespace halfplane::explain
