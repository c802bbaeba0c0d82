// Forward declarations of CLI11's types: its own header takes seconds to compile.
#pragma once

namespace CLI {
class App;
class Option;
}  // namespace CLI
