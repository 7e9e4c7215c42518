// Messages of Verilated code: failed assertions, $error, $fatal. Verilator prints it to stdout, where results go; here it is
// kept for the harness. cmake/Rtl.cmake compiles Verilator's run time with these functions in the place of its own.
#pragma once

#include <string>

/// Stands for printf in Verilator's run time. Keeps the text for this thread.
void halfplane_verilated_print(const char* format, ...) __attribute__((format(printf, 1, 2)));

namespace halfplane {

/// The text printed in this thread since the last call.
[[nodiscard]] std::string take_verilated_text();

/// The message alone of a failed assertion; other text in one line.
[[nodiscard]] std::string assertion_message(const std::string& text);

}  // namespace halfplane
