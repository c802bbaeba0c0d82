# Prints the known name that is nearest to a mistyped one; nothing where none is near.
#
#   awk -f nearest_name.awk MISTYPED KNOWN...
#
# Names are compared without regard to case. Inserted, missing, wrong and swapped letters count one
# each, and at most a third of the letters may differ.

function least(a, b) { return a < b ? a : b }

# Restricted Damerau-Levenshtein distance of two texts.
function distance(a, b,    i, j, cost, d) {
  for (i = 0; i <= length(a); ++i) d[i, 0] = i
  for (j = 0; j <= length(b); ++j) d[0, j] = j
  for (i = 1; i <= length(a); ++i) {
    for (j = 1; j <= length(b); ++j) {
      cost = substr(a, i, 1) != substr(b, j, 1)
      d[i, j] = least(d[i - 1, j - 1] + cost, 1 + least(d[i - 1, j], d[i, j - 1]))
      if (i > 1 && j > 1 && substr(a, i - 1, 2) == substr(b, j, 1) substr(b, j - 1, 1))
        d[i, j] = least(d[i, j], d[i - 2, j - 2] + 1)
    }
  }
  return d[length(a), length(b)]
}

BEGIN {
  nearest = ""
  smallest = int(length(ARGV[1]) / 3) + 1
  for (n = 2; n < ARGC; ++n) {
    found = distance(toupper(ARGV[1]), ARGV[n])
    if (found < smallest) {
      smallest = found
      nearest = ARGV[n]
    }
  }
  if (nearest != "") print nearest
}
