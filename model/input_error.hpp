// The exception for invalid input.
#pragma once

#include <stdexcept>

namespace halfplane {

/// For invalid files, options and configurations; what() is one line that names the place and the remedy.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace halfplane
