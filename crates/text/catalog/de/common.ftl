common-language-name = Deutsch
