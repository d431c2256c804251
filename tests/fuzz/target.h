// What a fuzz target consists of: good inputs to start from, and a function that must survive any
// bytes. What must hold is said by GIVEWAY_CHECK, so a broken promise ends the process as a crash
// does. driver.cc or libFuzzer feeds it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace giveway::fuzz {

// Bytes, text or not.
using Input = std::string;

// Good inputs of this target. Not empty.
std::vector<Input> Samples();

}  // namespace giveway::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
