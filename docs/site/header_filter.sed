# What of a header Sphinx cannot show: the namespace around it all, attributes, defaults that are lambdas or designated
# initialisers, and exceptions as fields of one word.
/^namespace stipple \{$/d
/^\}  \/\/ namespace stipple$/d
s/\[\[nodiscard\]\] //g
s/ = \[\]\(double\) \{ return true; \}//
s/ *(= )?\{\.[^}]*\}//
s/\\throws/Throws/
