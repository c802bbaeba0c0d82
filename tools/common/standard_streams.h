// stdout, stderr and stdin, whatever whoever started the tool has made of them.
#pragma once

#include <string>

namespace bnvpl {

// Gives stdin, stdout and stderr something to be when they are closed: else the next file that is
// opened takes the number, and gets what is printed. Using them still fails, as on a closed one.
void occupyClosedStreams();

// For text that was asked for, such as --help or what vpl-inspect finds: throws OutputError when
// stdout cannot take it.
void print(const std::string& text);

// For text that comes along: whether stdout took it.
bool tryPrint(const std::string& text);

}  // namespace bnvpl
