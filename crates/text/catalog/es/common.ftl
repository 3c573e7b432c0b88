common-language-name = Español
