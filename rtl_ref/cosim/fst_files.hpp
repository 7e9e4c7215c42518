// The files of Verilator's waveforms. Its writer (gtkwave/fstapi.c) looks at no write that fails, and maps files that are
// shorter than assumed: on a full disk that is SIGBUS. fst_files.cpp compiles the writer against these functions.
#pragma once

#include <string>

namespace halfplane {

/// To be called before a waveform is opened: the writer's temporary files go into `folder`, on the disk of the
/// waveform. `folder` ends with a slash; empty: the current folder.
void begin_fst(const std::string& folder);

/// The errno of the first failed file operation of this thread since then; 0: none failed.
[[nodiscard]] int fst_error();

}  // namespace halfplane
