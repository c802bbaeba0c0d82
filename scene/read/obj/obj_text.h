// Lines and names of OBJ and MTL files, before tinyobjloader sees them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

// Without a UTF-8 byte order mark; a line that ends in a backslash, blanks behind it or not, goes
// on with the next, but for comments. Each joined line is followed by as many empty ones: the
// others keep their numbers. Lines may end in \n, \r\n or \r.
std::string logicalLines(std::string text);

inline bool isBlank(char c) { return c == ' ' || c == '\t'; }
std::string_view trimmed(std::string_view text);  // without blanks at its ends
std::vector<std::string_view> wordsOf(std::string_view text);

// tinyobjloader ends the name of a usemtl at its first blank. So names travel as one word: blanks
// become control characters, which no name holds.
void makeOneWord(char* begin, const char* end);
std::string oneWord(std::string_view name);
std::string fromOneWord(std::string_view word);

// The words of an mtllib line. A backslash before a blank makes it part of the name.
std::vector<std::string> namesInList(std::string_view list);

// Without white space at its end.
std::string firstLine(std::string text);

}  // namespace bnvpl
