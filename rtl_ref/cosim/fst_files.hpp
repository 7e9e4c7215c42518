// The files of Verilator's waveforms. Its writer (gtkwave/fstapi.c) looks at no write that fails, and maps files that are
// not as long as it thinks: on a full disk that is SIGBUS. fst_files.cpp compiles it on these functions.
#pragma once

#include <string>

namespace halfplane {

/// To be called before a waveform is opened: its writer's temporary files lie in `folder`, on the disk that it goes to.
/// `folder` ends with a slash; empty: where the program runs.
void begin_fst(const std::string& folder);

/// The errno of the first file operation of this thread that failed since then; 0: none has.
[[nodiscard]] int fst_error();

}  // namespace halfplane
