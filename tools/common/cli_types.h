// CLI11's types by name, for headers: the library itself takes seconds to compile.
#pragma once

namespace CLI {
class App;
class Option;
}  // namespace CLI
