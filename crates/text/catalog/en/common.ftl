# The name of the language, in the language itself.
common-language-name = English
