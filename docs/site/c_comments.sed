# The comments of the C headers, which are plain C, as Doxygen reads them: above a declaration and
# behind one.
1s,^/\* ,/** @file\n,
/^\/\* ----/d
s,^( *)/\* ,\1/** ,
s,([;\,{] *)/\* ,\1/**< ,
s,; +/\*\*< (.*) \*/$,;  ///< \1,
