// What is thrown where input enters.
#pragma once

#include <stdexcept>

namespace halfplane {

/// For files, options and configurations that do not fit; what() is one line that names the place and the mend.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace halfplane
