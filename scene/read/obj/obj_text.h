// Lines and names of OBJ and MTL files, before tinyobjloader sees them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bnvpl {

// Blanks out a UTF-8 byte order mark, and joins lines that end in a backslash (blanks may follow
// it) with the next, except in comments. Empty lines follow each joined line, so that the others
// keep their numbers. Lines may end in \n, \r\n or \r.
std::string logicalLines(std::string text);

inline bool isBlank(char c) { return c == ' ' || c == '\t'; }
std::string_view trimmed(std::string_view text);  // without blanks at its ends
std::vector<std::string_view> wordsOf(std::string_view text);

// tinyobjloader ends the name of a usemtl at its first blank. Names are therefore passed as one
// word: control characters, which no name holds, replace blanks.
void makeOneWord(char* begin, const char* end);
std::string oneWord(std::string_view name);
std::string fromOneWord(std::string_view word);

// The words of an mtllib line. A backslash before a blank makes it part of the name.
std::vector<std::string> namesInList(std::string_view list);

// The first line of a text, without trailing white space.
std::string firstLine(std::string text);

}  // namespace bnvpl
